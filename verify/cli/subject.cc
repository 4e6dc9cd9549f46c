#include "cguide/verify/cli/subject.h"

#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/io/file_internal.h"
#include "cguide/numeric/io/foreign_path.h"
#include "cguide/numeric/io/guide_io.h"
#include "cguide/verify/cli/console.h"

namespace cguide::cli {
namespace {

using numeric::io::PathFormat;

std::vector<std::string> Cut(const std::string& text) {
  std::vector<std::string> fields(1);
  for (const char c : text) {
    if (c == ',') {
      fields.emplace_back();
    } else {
      fields.back() += c;
    }
  }
  return fields;
}

Pose ReadRoot(const std::string& text) {
  const auto refuse = [&](const std::string& why) {
    throw Error(Error::Code::kBadInput,
                "--root " + text + ": " + why + "; give x,y,z,qx,qy,qz,qw with a unit quaternion");
  };
  std::vector<double> values;
  for (const std::string& field : Cut(text)) {
    char* end = nullptr;
    values.push_back(std::strtod(field.c_str(), &end));
    const bool whole = !field.empty() && *end == 0;
    if (!whole || !(std::abs(values.back()) <= 1e6)) refuse('"' + field + "\" is no such number");
  }
  if (values.size() != 7) refuse(std::to_string(values.size()) + " numbers");
  return {{values[0], values[1], values[2]}, {values[3], values[4], values[5], values[6]}};
}

PathFormat FormatOf(const std::string& path_file, const PathArguments& reading) {
  if (reading.format == "guide") return PathFormat::kGuide;
  if (reading.format == "csv") return PathFormat::kCsv;
  if (reading.format == "ompl") return PathFormat::kOmpl;
  if (reading.format == "moveit") return PathFormat::kMoveIt;
  return numeric::io::DetectPathFormat(path_file);
}

// An option that would not be looked at is a mistake of the caller's.
void RefuseIdleOptions(const std::string& path_file, PathFormat format,
                       const PathArguments& reading) {
  const auto refuse = [&](const std::string& why) {
    throw Error(Error::Code::kBadInput, path_file + ": " + why);
  };
  if (!reading.joint_order.empty() && format != PathFormat::kOmpl) {
    refuse("--joint-order is for OMPL matrices; this file names its joints itself");
  }
  if (!reading.root.empty() && (format == PathFormat::kGuide || format == PathFormat::kCsv)) {
    refuse("--root is for matrices and trajectories; this file has the root's pose itself");
  }
}

Path ReadPath(const CommonArguments& common, const std::string& path_file, PathFormat format,
              const Robot& robot, const PathArguments& reading) {
  if (format == PathFormat::kCsv) return numeric::io::ReadPathCsv(path_file, robot);
  numeric::io::ForeignPathOptions options;
  if (!reading.joint_order.empty()) options.joint_order = Cut(reading.joint_order);
  if (!reading.root.empty()) options.X_WB = ReadRoot(reading.root);
  if (format == PathFormat::kOmpl) return numeric::io::ReadPathOmpl(path_file, robot, options);
  std::vector<std::string> notes;
  Path path = numeric::io::ReadPathMoveIt(path_file, robot, options, &notes);
  for (const std::string& note : notes) Say(common, note);
  return path;
}

Subject ReadForeignPath(const CommonArguments& common, const std::string& path_file,
                        const std::string& problem_file, PathFormat format,
                        const PathArguments& reading, const ProblemReader& read_problem) {
  if (problem_file.empty()) {
    throw Error(Error::Code::kBadInput,
                path_file + ": such a path names no problem; give one with --problem FILE");
  }
  Subject subject;
  subject.problem_file = problem_file;
  subject.problem = read_problem(problem_file);
  Warn(common, subject.problem.warnings);
  subject.path = ReadPath(common, path_file, format, subject.problem.model.robot, reading);
  return subject;
}

}  // namespace

Subject ReadSubject(const CommonArguments& common, const std::string& path_file,
                    const std::string& problem_file, const PathArguments& reading,
                    const ProblemReader& read_problem) {
  const std::filesystem::path file(path_file);
  const PathFormat format = FormatOf(path_file, reading);
  RefuseIdleOptions(path_file, format, reading);
  if (format != PathFormat::kGuide) {
    return ReadForeignPath(common, path_file, problem_file, format, reading, read_problem);
  }
  const numeric::io::Guide guide = numeric::io::ReadGuide(file);
  Subject subject;
  subject.problem_file = problem_file.empty()
                             ? (file.parent_path() / guide.problem_file).lexically_normal().string()
                             : problem_file;
  subject.problem = read_problem(subject.problem_file);
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

check::Certificate ReadCertificate(const std::string& file) {
  constexpr std::size_t kMostBytes = std::size_t{256} << 20;
  const std::string bytes = numeric::io::ReadFileBytes(file, kMostBytes);
  try {
    return check::ParseCertificate(bytes);
  } catch (const Error& e) {
    throw Error(e.code(), file + ": " + e.what());
  }
}

bool IsAbout(const check::Certificate& certificate, const Subject& subject) {
  return certificate.model == subject.problem.model &&
         certificate.path.waypoints == subject.path.waypoints &&
         certificate.path.joint_names == subject.path.joint_names;
}

}  // namespace cguide::cli
