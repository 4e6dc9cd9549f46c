#include <algorithm>
#include <array>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/io/file_internal.h"
#include "cguide/numeric/io/guide_io.h"

namespace cguide::numeric::io {
namespace {

constexpr std::size_t kMaxCsvBytes = 256u << 20;
constexpr std::array<const char*, 7> kRoot = {"x", "y", "z", "qx", "qy", "qz", "qw"};

class CsvReader {
 public:
  CsvReader(const std::filesystem::path& file, const Robot& robot)
      : file_(file.string()), robot_(robot), expected_(kRoot.begin(), kRoot.end()) {
    for (const std::string& name : ColumnNames(robot)) expected_.push_back(name);
  }

  Path Read(std::string_view text) {
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    Path path;
    path.joint_names = ColumnNames(robot_);
    while (!text.empty()) {
      const std::size_t end = text.find('\n');
      const std::string_view line = text.substr(0, end);
      text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
      ++line_;
      if (line.find_first_not_of(" \t\r") == std::string_view::npos) continue;
      if (places_.empty()) {
        ReadHeader(CutAtCommas(line));
      } else {
        path.waypoints.push_back(ReadRow(CutAtCommas(line)));
      }
    }
    if (places_.empty())
      Fail("the file is empty; its first line names the columns " + Join(expected_));
    if (path.waypoints.empty()) Fail("no waypoint follows the header; give one line for each");
    return path;
  }

 private:
  [[noreturn]] void Fail(const std::string& why) const {
    throw Error(Error::Code::kBadInput, file_ + ":" + std::to_string(line_) + ": " + why);
  }

  void ReadHeader(const std::vector<std::string_view>& fields) {
    for (std::string_view field : fields) {
      const auto found = std::find(expected_.begin(), expected_.end(), field);
      if (found == expected_.end()) {
        Fail("the column " + Quote(field) + " is unknown; did you mean \"" +
             NearestName(field, expected_) + "\"? Expected: " + Join(expected_));
      }
      const int place = static_cast<int>(found - expected_.begin());
      if (std::find(places_.begin(), places_.end(), place) != places_.end()) {
        Fail("the column " + Quote(field) + " stands twice; keep one of them");
      }
      places_.push_back(place);
    }
    for (std::size_t i = 0; i < expected_.size(); ++i) {
      if (std::find(places_.begin(), places_.end(), static_cast<int>(i)) == places_.end()) {
        Fail("the column \"" + expected_[i] + "\" is missing; the robot needs it");
      }
    }
  }

  Configuration ReadRow(const std::vector<std::string_view>& fields) const {
    if (fields.size() != places_.size()) {
      Fail(std::to_string(fields.size()) + " values where the header names " +
           std::to_string(places_.size()) + " columns; is the file complete?");
    }
    std::vector<double> values(fields.size());
    for (std::size_t i = 0; i < fields.size(); ++i) {
      std::string why;
      const double value = ParseDouble(fields[i], &why);
      const std::string& column = expected_[static_cast<std::size_t>(places_[i])];
      if (!why.empty()) Fail("column \"" + column + "\": " + Quote(fields[i]) + " " + why);
      if (value > 1e6 || value < -1e6) {
        Fail("column \"" + column + "\": " + Quote(fields[i]) +
             " exceeds 1e6; SI units and radians are expected");
      }
      values[static_cast<std::size_t>(places_[i])] = value;
    }
    Configuration q;
    q.X_WB = {{values[0], values[1], values[2]}, {values[3], values[4], values[5], values[6]}};
    q.joints = Eigen::Map<const Eigen::VectorXd>(values.data() + kRoot.size(), robot_.num_columns);
    return q;
  }

  std::string file_;
  const Robot& robot_;
  std::vector<std::string> expected_;
  std::vector<int> places_;  // per column of the file: index into expected_
  int line_ = 0;
};

}  // namespace

Path ReadPathCsv(const std::filesystem::path& file, const Robot& robot) {
  const std::string text = ReadTextFile(file, kMaxCsvBytes);
  Path path = CsvReader(file, robot).Read(text);
  try {
    CheckPath(path, robot);
  } catch (const Error& e) {
    throw Error(e.code(), file.string() + ": " + e.what());
  }
  return path;
}

std::string WritePathCsv(const Path& path) {
  std::string text;
  for (const char* name : kRoot) text += (text.empty() ? "" : ",") + std::string(name);
  for (const std::string& name : path.joint_names) text += "," + name;
  text += "\n";
  for (const Configuration& q : path.waypoints) {
    const Pose& X = q.X_WB;
    text += ShortestDouble(X.p[0]);
    for (double value : {X.p[1], X.p[2], X.q.x, X.q.y, X.q.z, X.q.w}) {
      text += "," + ShortestDouble(value);
    }
    for (double value : q.joints) text += "," + ShortestDouble(value);
    text += "\n";
  }
  return text;
}

}  // namespace cguide::numeric::io
