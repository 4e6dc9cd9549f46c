#pragma once

#include <tinyxml2.h>

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "cguide/exact/core/error.h"

namespace cguide::numeric::io {

/** No coordinate, mass, limit or factor of a description may exceed this in magnitude: beyond it
 lie unit mistakes and the inputs on which float code overflows. */
inline constexpr double kLargestNumber = 1e6;

/** The bytes of a regular file. @throws Error: kIo where it cannot be read, kBadInput where it is
 empty or larger than `limit` bytes. */
std::string ReadBytes(const std::filesystem::path& file, std::uintmax_t limit);

/** An XML file in memory that knows where its elements stand. */
class XmlFile {
 public:
  /** @throws Error (kIo, kBadInput): missing, empty, binary, malformed, more than one root element.
   */
  explicit XmlFile(const std::filesystem::path& file);

  const std::filesystem::path& path() const { return path_; }
  const tinyxml2::XMLDocument& document() const { return document_; }
  const tinyxml2::XMLElement& root() const { return *document_.RootElement(); }

  /** "file:line" of an element. */
  std::string Place(const tinyxml2::XMLElement& element) const;

  /** @throws Error (kBadInput) "file:line: what; remedy". */
  [[noreturn]] void Refuse(const tinyxml2::XMLElement& element, const std::string& what,
                           const std::string& remedy) const;

  /** A required, non-empty attribute. */
  std::string Text(const tinyxml2::XMLElement& element, const char* attribute) const;

  /** `count` finite doubles of an attribute, each the double nearest to its decimal, at most
   kLargestNumber in magnitude. */
  std::vector<double> Numbers(const tinyxml2::XMLElement& element, const char* attribute,
                              std::size_t count) const;

  /** A required number. */
  double Number(const tinyxml2::XMLElement& element, const char* attribute) const;

  /** A number, or `fallback` where the attribute is absent. */
  double Number(const tinyxml2::XMLElement& element, const char* attribute, double fallback) const;

  /** Three numbers, or `fallback` where the attribute is absent. */
  Eigen::Vector3d Vector(const tinyxml2::XMLElement& element, const char* attribute,
                         const Eigen::Vector3d& fallback) const;

 private:
  std::filesystem::path path_;
  tinyxml2::XMLDocument document_;
};

/** The children of `parent` that are called `name`, in document order. */
std::vector<const tinyxml2::XMLElement*> Children(const tinyxml2::XMLElement& parent,
                                                  const char* name);

/** The finite double nearest to a decimal ("-1", "+.5", "2.e-3"), in every locale.
 @throws Error (kBadInput) that quotes the word; the caller adds the place. */
double ParseNumber(std::string_view word);

/** The numbers of a text separated by white space. */
std::vector<double> ParseNumbers(std::string_view text);

/** Calls `read` and puts "place: " before the message of an Error that does not begin with it. */
template <typename Read>
auto ReadAt(const std::string& place, const Read& read) {
  try {
    return read();
  } catch (const Error& error) {
    const std::string message = error.what();
    if (message.starts_with(place)) throw;
    throw Error(error.code(), place + ": " + message);
  }
}

/** "a", "b" and 3 more: names for a message, at most `limit` of them in full. */
std::string ListNames(const std::vector<std::string>& names, std::size_t limit = 5);

}  // namespace cguide::numeric::io
