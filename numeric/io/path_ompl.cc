#include <algorithm>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/io/file_internal.h"
#include "cguide/numeric/io/foreign_path.h"

namespace cguide::numeric::io {
namespace {

constexpr std::size_t kMaxMatrixBytes = 256u << 20;
constexpr const char* kBlanks = " \t\r";
constexpr std::size_t kRootColumns = 7;

std::vector<std::string_view> Words(std::string_view line) {
  std::vector<std::string_view> words;
  for (std::size_t at = 0; (at = line.find_first_not_of(kBlanks, at)) != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(kBlanks, at), line.size());
    words.push_back(line.substr(at, end - at));
    at = end;
  }
  return words;
}

/** For each column of the file after the root: the column of the robot. */
std::vector<Eigen::Index> JointPlaces(const std::vector<std::string>& names,
                                      const std::vector<std::string>& order) {
  std::vector<Eigen::Index> places;
  const auto fail = [](const std::string& why) {
    throw Error(Error::Code::kBadInput, "--joint-order: " + why);
  };
  for (const std::string& name : order) {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) fail("joint " + UnknownWord(name, names));
    const Eigen::Index place = found - names.begin();
    if (std::find(places.begin(), places.end(), place) != places.end()) {
      fail("the joint " + Quote(name) + " stands twice; name each once");
    }
    places.push_back(place);
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (std::find(places.begin(), places.end(), static_cast<Eigen::Index>(i)) == places.end()) {
      fail("the joint \"" + names[i] + "\" is missing; the robot needs it");
    }
  }
  return places;
}

class MatrixReader {
 public:
  MatrixReader(const std::filesystem::path& file, const Robot& robot,
               const ForeignPathOptions& options)
      : file_(file.string()), names_(ColumnNames(robot)), X_WB_(options.X_WB) {
    places_ = JointPlaces(names_, options.joint_order.empty() ? names_ : options.joint_order);
    if (!X_WB_) columns_ = {"x", "y", "z", "qx", "qy", "qz", "qw"};
    for (const Eigen::Index place : places_) {
      columns_.push_back(names_[static_cast<std::size_t>(place)]);
    }
  }

  Path Read(std::string_view text) {
    Path path;
    path.joint_names = names_;
    bool ended = false;
    while (!text.empty()) {
      ++line_;
      const std::size_t end = text.find('\n');
      const std::vector<std::string_view> words = Words(text.substr(0, end));
      if (words.empty()) {
        ended = !path.waypoints.empty();
      } else {
        if (ended) Fail("a second path follows an empty line; keep one path a file");
        if (end == std::string_view::npos) {
          Fail("the last line does not end; is the file complete? If it is, add a line end");
        }
        path.waypoints.push_back(ReadState(words));
      }
      text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    }
    if (path.waypoints.empty()) Fail("the file has no state; give one line for each");
    return path;
  }

 private:
  [[noreturn]] void Fail(const std::string& why) const {
    throw Error(Error::Code::kBadInput, file_ + ":" + std::to_string(line_) + ": " + why);
  }

  double ReadNumber(std::string_view word, std::size_t column) const {
    const std::string place =
        "column " + std::to_string(column + 1) + " (" + columns_[column] + "): " + Quote(word);
    std::string why;
    const double value = ParseDouble(word, &why);
    if (!why.empty()) Fail(place + " " + why);
    if (value > 1e6 || value < -1e6)
      Fail(place + " exceeds 1e6; SI units and radians are expected");
    return value;
  }

  Configuration ReadState(const std::vector<std::string_view>& words) const {
    if (words.size() != columns_.size()) {
      Fail(std::to_string(words.size()) + " values where the robot needs " +
           std::to_string(columns_.size()) + " (" + Join(columns_) + "); is the file complete?");
    }
    std::vector<double> values;
    for (std::size_t i = 0; i < words.size(); ++i) values.push_back(ReadNumber(words[i], i));
    Configuration q;
    std::size_t first = 0;
    if (X_WB_) {
      q.X_WB = *X_WB_;
    } else {
      q.X_WB = {{values[0], values[1], values[2]}, {values[3], values[4], values[5], values[6]}};
      first = kRootColumns;
    }
    q.joints.resize(static_cast<Eigen::Index>(places_.size()));
    for (std::size_t i = 0; i < places_.size(); ++i) q.joints[places_[i]] = values[first + i];
    return q;
  }

  std::string file_;
  std::vector<std::string> names_;  // of the robot's columns
  std::optional<Pose> X_WB_;
  std::vector<Eigen::Index> places_;
  std::vector<std::string> columns_;  // of the file
  int line_ = 0;
};

}  // namespace

Path ReadPathOmpl(const std::filesystem::path& file, const Robot& robot,
                  const ForeignPathOptions& options) {
  const std::string text = ReadTextFile(file, kMaxMatrixBytes);
  Path path = MatrixReader(file, robot, options).Read(text);
  try {
    CheckPath(path, robot);
  } catch (const Error& e) {
    throw Error(e.code(), file.string() + ": " + e.what());
  }
  return path;
}

}  // namespace cguide::numeric::io
