// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "cguide/exact/core/error.h"
#include "cguide/verify/check/json_internal.h"

namespace cguide::check {
namespace {

using nlohmann::json;

constexpr std::size_t kMaxBytes = 256u << 20;
constexpr int kMaxDepth = 200;
/** A value takes at most about 100 bytes once read, so this is 3 GB; 256 MiB of plain doubles are
 some 15 million. */
constexpr long kMaxValues = 30'000'000;

[[noreturn]] void Refuse(const std::string& why) { throw Error(Error::Code::kBadInput, why); }

/** Keeps the keys of every open object: the parser itself would keep the last of repeated ones. */
class KeyGuard {
 public:
  bool operator()(int depth, json::parse_event_t event, json& value) {
    if (depth > kMaxDepth) Refuse("nested deeper than 200 levels; no certificate is");
    if (++events_ > kMaxValues) Refuse("more than 30 million values; split the certificate");
    if (event == json::parse_event_t::object_start) open_.emplace_back();
    if (event == json::parse_event_t::object_end) open_.pop_back();
    if (event == json::parse_event_t::key &&
        !open_.back().insert(value.get<std::string>()).second) {
      Refuse("the key " + value.dump(-1, ' ', true, json::error_handler_t::replace) +
             " stands twice in one object");
    }
    return true;
  }

 private:
  std::vector<std::set<std::string>> open_;
  long events_ = 0;
};

}  // namespace

json ParseJson(const std::string& text) {
  if (text.size() > kMaxBytes) Refuse("larger than 256 MiB; split the certificate");
  try {
    return json::parse(text, KeyGuard());
  } catch (const json::exception& e) {
    Refuse(std::string("this is not JSON (") + e.what() + "); is the file complete?");
  }
}

std::string View::Pointer() const {
  if (!parent_) return {};
  return parent_->Pointer() + "/" + (key_ ? std::string(key_) : std::to_string(index_));
}

void View::Fail(const std::string& why) const {
  const std::string pointer = Pointer();
  Refuse((pointer.empty() ? "the file" : pointer) + ": " + why);
}

void View::AllowKeys(std::initializer_list<const char*> known) const {
  if (!value_.is_object()) Fail("an object is expected here");
  for (const auto& [key, value] : value_.items()) {
    const bool found =
        std::any_of(known.begin(), known.end(), [&k = key](const char* name) { return k == name; });
    if (!found) {
      Fail("the key " + json(key).dump(-1, ' ', true, json::error_handler_t::replace) +
           " is unknown");
    }
  }
}

bool View::Has(const char* key) const { return value_.is_object() && value_.contains(key); }

View View::Get(const char* key) const {
  if (!value_.is_object()) Fail("an object is expected here");
  const auto found = value_.find(key);
  if (found == value_.end()) Fail(std::string("the key \"") + key + "\" is missing");
  return View(*found, this, key, 0);
}

std::size_t View::Size() const {
  if (!value_.is_array()) Fail("a list is expected here");
  return value_.size();
}

View View::At(std::size_t i) const {
  if (i >= Size()) Fail("the list has only " + std::to_string(Size()) + " elements");
  return View(value_[i], this, nullptr, i);
}

std::string View::Text() const {
  if (!value_.is_string()) Fail("text is expected here");
  return value_.get<std::string>();
}

bool View::Bool() const {
  if (!value_.is_boolean()) Fail("true or false is expected here");
  return value_.get<bool>();
}

double View::AnyNumber() const {
  if (!value_.is_number()) Fail("a number is expected here");
  const double number = value_.get<double>();
  if (!std::isfinite(number)) Fail("the number is not finite");
  return number;
}

double View::Number() const {
  const double number = AnyNumber();
  if (std::abs(number) > 1e9) Fail("the number is beyond 1e9");
  return number;
}

int View::Index(std::size_t end) const {
  if (!value_.is_number_unsigned()) Fail("a whole number >= 0 is expected here");
  const auto number = value_.get<std::uint64_t>();
  if (number >= end || number > 1'000'000'000) {
    Fail(std::to_string(number) + " names nothing; there are " + std::to_string(end));
  }
  return static_cast<int>(number);
}

Eigen::Vector3d View::Vector3(std::size_t first) const {
  if (first == 0 && Size() != 3) Fail("three numbers are expected here");
  return {At(first).Number(), At(first + 1).Number(), At(first + 2).Number()};
}

}  // namespace cguide::check
