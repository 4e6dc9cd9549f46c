#include "cguide/verify/cli/subject.h"

#include <filesystem>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/io/guide_io.h"
#include "cguide/numeric/io/problem_reader.h"
#include "cguide/verify/cli/console.h"

namespace cguide::cli {
namespace {

Subject ReadForeignPath(const CommonArguments& common, const std::string& path_file,
                        const std::string& problem_file) {
  if (problem_file.empty()) {
    throw Error(Error::Code::kBadInput,
                path_file + ": a CSV path names no problem; give one with --problem FILE");
  }
  Subject subject;
  subject.problem_file = problem_file;
  subject.problem = numeric::io::ReadProblem(problem_file);
  Warn(common, subject.problem.warnings);
  subject.path = numeric::io::ReadPathCsv(path_file, subject.problem.model.robot);
  return subject;
}

}  // namespace

Subject ReadSubject(const CommonArguments& common, const std::string& path_file,
                    const std::string& problem_file) {
  const std::filesystem::path file(path_file);
  if (file.extension() == ".csv") return ReadForeignPath(common, path_file, problem_file);
  const numeric::io::Guide guide = numeric::io::ReadGuide(file);
  Subject subject;
  subject.problem_file = problem_file.empty()
                             ? (file.parent_path() / guide.problem_file).lexically_normal().string()
                             : problem_file;
  subject.problem = numeric::io::ReadProblem(subject.problem_file);
  Warn(common, subject.problem.warnings);
  if (guide.model_digest != subject.problem.model_digest) {
    Say(common, "warning: " + path_file + " was planned for another model than " +
                    subject.problem_file + " describes now; the answers are about the present one");
  }
  subject.path = guide.path;
  CheckPath(subject.path, subject.problem.model.robot);
  subject.edges = guide.edges;
  subject.origin = "cguide " + guide.tool_version + ", seed " + std::to_string(guide.seed);
  return subject;
}

}  // namespace cguide::cli
