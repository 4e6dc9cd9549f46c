#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "cguide/exact/core/path.h"
#include "cguide/numeric/io/problem_reader.h"
#include "cguide/numeric/problem.h"
#include "cguide/verify/check/certificate.h"
#include "cguide/verify/cli/commands.h"

namespace cguide::cli {

/** A path to look at and the problem it belongs to. */
struct Subject {
  numeric::Problem problem;
  std::string problem_file;
  Path path;
  std::string edges;   ///< how its maker tested it; empty for foreign paths
  std::string origin;  ///< tool version and seed; empty for foreign paths
};

using ProblemReader = std::function<numeric::Problem(const std::filesystem::path& file)>;

/** Reads a guide (JSON; its problem is the one it names unless `problem_file` is given) or a
 foreign path (numeric/io/foreign_path.h; `problem_file` must be given). Warns where the model has
 changed since, and says what of the file was not looked at.
 `read_problem` reads the problem file. @throws Error (kBadInput, kIo). */
Subject ReadSubject(const CommonArguments& common, const std::string& path_file,
                    const std::string& problem_file, const PathArguments& reading = {},
                    const ProblemReader& read_problem = numeric::io::ReadProblem);

/** @throws Error, with the file's name, where it cannot be read or is no certificate. */
check::Certificate ReadCertificate(const std::string& file);

/** Whether a certificate is about this model and this path, and not another one. */
bool IsAbout(const check::Certificate& certificate, const Subject& subject);

}  // namespace cguide::cli
