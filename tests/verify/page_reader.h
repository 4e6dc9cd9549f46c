#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace cguide::verify {

/** The tags of an HTML text in order, "name" or "/name", read as a browser's tokenizer reads a
 plain document: the content of script and style elements is raw. Throws std::runtime_error at a tag
 that is not closed, at an element that is closed out of turn or not at all, and at an attribute
 whose value is not quoted. */
std::vector<std::string> ReadTags(const std::string& html);

/** The text of the element with that id. Entities stay as they are. */
std::string TextOf(const std::string& html, const std::string& id);

/** What the page's script reads. */
struct PackedPage {
  explicit PackedPage(const std::string& html);
  /** Words of a run [first, count] as floats or as integers. */
  std::vector<float> Floats(const nlohmann::json& run) const;
  std::vector<std::uint32_t> Words(const nlohmann::json& run) const;

  nlohmann::json json;
  std::vector<std::uint32_t> words;
};

}  // namespace cguide::verify
