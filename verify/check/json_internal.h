// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <string>

#include "cguide/exact/core/model.h"

namespace cguide::check {

/** Parses a text. Repeated keys, nesting beyond 200 levels, texts beyond 256 MiB and more than 30
 million values are refused. @throws Error (kBadInput) with the byte. */
nlohmann::json ParseJson(const std::string& text);

/** A value and the way to it, which a refusal names. Borrows the value and the view it came from.
 */
class View {
 public:
  explicit View(const nlohmann::json& value) : value_(value) {}

  /** Throws Error (kBadInput) "/pointer: why". */
  [[noreturn]] void Fail(const std::string& why) const;

  /** Refuses keys that are not listed. */
  void AllowKeys(std::initializer_list<const char*> known) const;
  bool Has(const char* key) const;
  View Get(const char* key) const;
  std::size_t Size() const;
  View At(std::size_t i) const;

  std::string Text() const;
  bool Bool() const;
  /** Finite and at most 1e9 in size. */
  double Number() const;
  /** Finite. */
  double AnyNumber() const;
  /** 0 <= value < end. */
  int Index(std::size_t end) const;
  Eigen::Vector3d Vector3(std::size_t first = 0) const;  ///< of the list's elements from `first` on

 private:
  View(const nlohmann::json& value, const View* parent, const char* key, std::size_t index)
      : value_(value), parent_(parent), key_(key), index_(index) {}
  std::string Pointer() const;

  const nlohmann::json& value_;
  const View* parent_ = nullptr;
  const char* key_ = nullptr;
  std::size_t index_ = 0;
};

/** The canonical model, as `cguide model` writes it. @throws Error (kBadInput). */
Model ReadModel(const View& view);

}  // namespace cguide::check
