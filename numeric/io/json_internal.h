#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cguide/exact/core/pose.h"

namespace cguide::numeric::io {

/** Parses a JSON file. Repeated keys, nesting deeper than 32 and files above 256 MiB are refused.
 @throws Error (kBadInput, kIo) "file:line: why". */
nlohmann::json ReadJson(const std::filesystem::path& file);

/** A JSON value together with its file and JSON pointer. Every refusal throws Error (kBadInput)
 "file: /pointer: why". Borrows the value and the file name. */
class JsonView {
 public:
  JsonView(const nlohmann::json& value, const std::string& file) : value_(&value), file_(&file) {}

  [[noreturn]] void Fail(const std::string& why) const;

  bool IsNumber() const;
  void AllowKeys(const std::vector<std::string>& known) const;
  std::optional<JsonView> Find(const std::string& key) const;
  JsonView Get(const std::string& key) const;
  std::vector<std::string> Keys() const;

  /** Elements of a list. */
  std::size_t Size() const;
  JsonView At(std::size_t i) const;

  std::string Text() const;
  bool Bool() const;
  double Number() const;
  std::int64_t Integer(std::int64_t low, std::int64_t high) const;
  std::uint64_t Unsigned() const;
  int Choice(const std::vector<std::string>& words) const;
  Eigen::Vector3d Vector3() const;

 private:
  JsonView(const nlohmann::json& value, const JsonView& parent, const std::string& step);

  const nlohmann::json* value_;
  const std::string* file_;
  std::string pointer_;
};

/** A JSON string. @throws Error (kBadInput) where the text is not UTF-8. */
std::string JsonText(const std::string& text);
/** "[x, y, z]", shortest doubles. */
std::string JsonVector(const Eigen::Vector3d& v);
/** "[x, y, z, w]", shortest doubles. */
std::string JsonQuaternion(const Quaternion& q);

}  // namespace cguide::numeric::io
