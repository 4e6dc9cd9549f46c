#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/io/file_internal.h"
#include "cguide/numeric/io/json_internal.h"

namespace cguide::numeric::io {
namespace {

using nlohmann::json;

constexpr std::size_t kMaxJsonBytes = 256u << 20;
constexpr int kMaxDepth = 32;

// Keeps the keys of every open object, so that a repeated key is seen; the parser itself would keep
// the last one silently.
class KeyGuard {
 public:
  explicit KeyGuard(std::string place) : place_(std::move(place)) {}

  bool operator()(int depth, json::parse_event_t event, json& value) {
    if (depth > kMaxDepth) {
      throw Error(Error::Code::kBadInput, place_ + ": nested deeper than " +
                                              std::to_string(kMaxDepth) +
                                              " levels; no such file is");
    }
    if (event == json::parse_event_t::object_start) open_.emplace_back();
    if (event == json::parse_event_t::object_end) open_.pop_back();
    if (event == json::parse_event_t::key) {
      const std::string key = value.get<std::string>();
      if (!open_.back().insert(key).second) {
        throw Error(Error::Code::kBadInput, place_ + ": the key " + Quote(key) +
                                                " stands twice in one object; keep one of them");
      }
    }
    return true;
  }

 private:
  std::string place_;
  std::vector<std::set<std::string>> open_;
};

std::string LineOfByte(const std::string& text, std::size_t byte) {
  const auto end = text.begin() + static_cast<std::ptrdiff_t>(std::min(byte, text.size()));
  return std::to_string(1 + std::count(text.begin(), end, '\n'));
}

const char* Noun(const json& value) {
  if (value.is_object()) return "an object";
  if (value.is_array()) return "a list";
  if (value.is_string()) return "text";
  if (value.is_number()) return "a number";
  if (value.is_boolean()) return "true or false";
  return "null";
}

}  // namespace

json ReadJson(const std::filesystem::path& file) {
  const std::string text = ReadTextFile(file, kMaxJsonBytes);
  try {
    return json::parse(text, KeyGuard(file.string()));
  } catch (const json::parse_error& e) {
    throw Error(Error::Code::kBadInput, file.string() + ":" + LineOfByte(text, e.byte) +
                                            ": this is not JSON (" + e.what() +
                                            "); is the file complete?");
  } catch (const json::exception& e) {
    throw Error(Error::Code::kBadInput, file.string() + ": a value cannot be read (" + e.what() +
                                            "); numbers must fit a double");
  }
}

JsonView::JsonView(const json& value, const JsonView& parent, const std::string& step)
    : value_(&value), file_(parent.file_), pointer_(parent.pointer_ + "/" + step) {}

void JsonView::Fail(const std::string& why) const {
  throw Error(Error::Code::kBadInput,
              *file_ + ": " + (pointer_.empty() ? "the file" : pointer_) + ": " + why);
}

bool JsonView::IsNumber() const { return value_->is_number(); }

void JsonView::AllowKeys(const std::vector<std::string>& known) const {
  for (const std::string& key : Keys()) {
    if (std::find(known.begin(), known.end(), key) != known.end()) continue;
    Fail("the key " + Quote(key) + " is unknown; did you mean \"" + NearestName(key, known) +
         "\"? Known here: " + Join(known));
  }
}

std::optional<JsonView> JsonView::Find(const std::string& key) const {
  if (!value_->is_object()) Fail(std::string("an object is expected here, not ") + Noun(*value_));
  const auto found = value_->find(key);
  if (found == value_->end()) return std::nullopt;
  return JsonView(*found, *this, key);
}

JsonView JsonView::Get(const std::string& key) const {
  const std::optional<JsonView> value = Find(key);
  if (!value) Fail("the key \"" + key + "\" is missing; add it");
  return *value;
}

std::vector<std::string> JsonView::Keys() const {
  if (!value_->is_object()) Fail(std::string("an object is expected here, not ") + Noun(*value_));
  std::vector<std::string> keys;
  for (auto entry = value_->begin(); entry != value_->end(); ++entry) keys.push_back(entry.key());
  return keys;
}

std::size_t JsonView::Size() const {
  if (!value_->is_array()) Fail(std::string("a list is expected here, not ") + Noun(*value_));
  return value_->size();
}

JsonView JsonView::At(std::size_t i) const {
  if (i >= Size()) Fail("the list has only " + std::to_string(Size()) + " elements");
  return JsonView((*value_)[i], *this, std::to_string(i));
}

std::string JsonView::Text() const {
  if (!value_->is_string()) Fail(std::string("text is expected here, not ") + Noun(*value_));
  return value_->get<std::string>();
}

bool JsonView::Bool() const {
  if (!value_->is_boolean()) Fail("write true or false here");
  return value_->get<bool>();
}

double JsonView::Number() const {
  if (!value_->is_number()) Fail(std::string("a number is expected here, not ") + Noun(*value_));
  const double number = value_->get<double>();
  if (!std::isfinite(number)) Fail("the number is not finite");
  return number;
}

std::int64_t JsonView::Integer(std::int64_t low, std::int64_t high) const {
  const bool fits = value_->is_number_integer() &&
                    (!value_->is_number_unsigned() ||
                     value_->get<std::uint64_t>() <= static_cast<std::uint64_t>(INT64_MAX));
  if (!fits) Fail("a whole number is expected here");
  const auto number = value_->get<std::int64_t>();
  if (number < low || number > high) {
    Fail(std::to_string(number) + " is out of range; it must lie in " + std::to_string(low) + ".." +
         std::to_string(high));
  }
  return number;
}

std::uint64_t JsonView::Unsigned() const {
  if (!value_->is_number_unsigned()) Fail("a whole number >= 0 is expected here");
  return value_->get<std::uint64_t>();
}

int JsonView::Choice(const std::vector<std::string>& words) const {
  const std::string text = Text();
  const auto found = std::find(words.begin(), words.end(), text);
  if (found == words.end()) Fail(UnknownWord(text, words));
  return static_cast<int>(found - words.begin());
}

Eigen::Vector3d JsonView::Vector3() const {
  if (Size() != 3) Fail("three numbers are expected here, not " + std::to_string(Size()));
  return {At(0).Number(), At(1).Number(), At(2).Number()};
}

std::string JsonText(const std::string& text) {
  if (!IsUtf8(text)) {
    throw Error(Error::Code::kBadInput, "the name " + Quote(text) + " is not UTF-8; rename it");
  }
  return json(text).dump();
}

std::string JsonVector(const Eigen::Vector3d& v) {
  return "[" + ShortestDouble(v[0]) + ", " + ShortestDouble(v[1]) + ", " + ShortestDouble(v[2]) +
         "]";
}

std::string JsonQuaternion(const Quaternion& q) {
  return "[" + ShortestDouble(q.x) + ", " + ShortestDouble(q.y) + ", " + ShortestDouble(q.z) +
         ", " + ShortestDouble(q.w) + "]";
}

}  // namespace cguide::numeric::io
