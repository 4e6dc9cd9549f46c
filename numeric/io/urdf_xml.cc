#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/io/urdf_xml_internal.h"

namespace cguide::numeric::io {
namespace {

constexpr std::uintmax_t kLargestDescription = 64u << 20;

}  // namespace

std::string ReadBytes(const std::filesystem::path& file, std::uintmax_t limit) {
  const std::string name = file.string();
  std::error_code status;
  if (!std::filesystem::is_regular_file(file, status)) {
    throw Error(Error::Code::kIo, name + ": no such file; check the path");
  }
  std::ifstream in(file, std::ios::binary);
  const std::uintmax_t size = std::filesystem::file_size(file, status);
  if (!in || status) throw Error(Error::Code::kIo, name + ": cannot be read; check permissions");
  if (size == 0) throw Error(Error::Code::kBadInput, name + ": the file is empty");
  if (size > limit) {
    throw Error(Error::Code::kBadInput, name + ": the file has " + std::to_string(size) +
                                            " bytes, more than the " + std::to_string(limit) +
                                            " that are read");
  }
  std::string bytes(size, '\0');
  in.read(bytes.data(), static_cast<std::streamsize>(size));
  if (static_cast<std::uintmax_t>(in.gcount()) != size) {
    throw Error(Error::Code::kIo, name + ": could not be read to its end");
  }
  return bytes;
}

XmlFile::XmlFile(const std::filesystem::path& file) : path_(file) {
  const std::string bytes = ReadBytes(file, kLargestDescription);
  const std::string name = path_.string();
  if (bytes.find('\0') != std::string::npos) {
    throw Error(Error::Code::kBadInput, name + ": holds zero bytes, so it is no XML text");
  }
  if (document_.Parse(bytes.data(), bytes.size()) != tinyxml2::XML_SUCCESS) {
    throw Error(Error::Code::kBadInput,
                name + ":" + std::to_string(document_.ErrorLineNum()) + ": malformed XML (" +
                    tinyxml2::XMLDocument::ErrorIDToName(document_.ErrorID()) +
                    "); the file may be truncated or no XML at all");
  }
  if (document_.RootElement() == nullptr) {
    throw Error(Error::Code::kBadInput, name + ": holds no XML element");
  }
  for (const auto* node = root().NextSibling(); node != nullptr; node = node->NextSibling()) {
    if (node->ToElement() != nullptr || node->ToText() != nullptr) {
      throw Error(Error::Code::kBadInput,
                  name + ":" + std::to_string(node->GetLineNum()) +
                      ": there is text after the end of the root element; keep one of them");
    }
  }
}

std::string XmlFile::Place(const tinyxml2::XMLElement& element) const {
  return path_.string() + ":" + std::to_string(element.GetLineNum());
}

void XmlFile::Refuse(const tinyxml2::XMLElement& element, const std::string& what,
                     const std::string& remedy) const {
  throw Error(Error::Code::kBadInput, Place(element) + ": " + what + "; " + remedy);
}

std::string XmlFile::Text(const tinyxml2::XMLElement& element, const char* attribute) const {
  const char* text = element.Attribute(attribute);
  if (text == nullptr || *text == '\0') {
    Refuse(element, std::string("<") + element.Name() + "> has no attribute \"" + attribute + "\"",
           "give it one");
  }
  return text;
}

std::vector<double> XmlFile::Numbers(const tinyxml2::XMLElement& element, const char* attribute,
                                     std::size_t count) const {
  const std::string what =
      std::string("attribute \"") + attribute + "\" of <" + element.Name() + ">";
  std::vector<double> numbers;
  try {
    numbers = ParseNumbers(Text(element, attribute));
  } catch (const Error& error) {
    if (element.Attribute(attribute) == nullptr) throw;
    Refuse(element, what + ": " + error.what(), "write decimal numbers");
  }
  if (numbers.size() != count) {
    Refuse(element, what + " has " + std::to_string(numbers.size()) + " numbers",
           "it needs " + std::to_string(count));
  }
  for (double x : numbers) {
    if (std::abs(x) > kLargestNumber) {
      Refuse(element, what + " exceeds 1e6 in magnitude", "use metres, kilograms and radians");
    }
  }
  return numbers;
}

double XmlFile::Number(const tinyxml2::XMLElement& element, const char* attribute) const {
  return Numbers(element, attribute, 1)[0];
}

double XmlFile::Number(const tinyxml2::XMLElement& element, const char* attribute,
                       double fallback) const {
  return element.Attribute(attribute) == nullptr ? fallback : Number(element, attribute);
}

Eigen::Vector3d XmlFile::Vector(const tinyxml2::XMLElement& element, const char* attribute,
                                const Eigen::Vector3d& fallback) const {
  if (element.Attribute(attribute) == nullptr) return fallback;
  const std::vector<double> v = Numbers(element, attribute, 3);
  return {v[0], v[1], v[2]};
}

std::vector<const tinyxml2::XMLElement*> Children(const tinyxml2::XMLElement& parent,
                                                  const char* name) {
  std::vector<const tinyxml2::XMLElement*> result;
  for (const auto* child = parent.FirstChildElement(name); child != nullptr;
       child = child->NextSiblingElement(name)) {
    result.push_back(child);
  }
  return result;
}

double ParseNumber(std::string_view word) {
  const std::string quoted = "\"" + std::string(word) + "\"";
  // std::from_chars is correctly rounded and knows no locale. It takes no leading '+'.
  std::string_view digits = word;
  if (digits.starts_with('+') && !digits.starts_with("+-")) digits.remove_prefix(1);
  double value = 0;
  const char* end = digits.data() + digits.size();
  const auto [stop, status] = std::from_chars(digits.data(), end, value);
  if (status == std::errc::result_out_of_range && stop == end) {
    // Too small for any double but zero, unless it is too large.
    if (word.find("e-") != word.npos || word.find("E-") != word.npos) return 0;
    throw Error(Error::Code::kBadInput, quoted + " is beyond the range of doubles");
  }
  if (status != std::errc() || stop != end) {
    throw Error(Error::Code::kBadInput, quoted + " is no number");
  }
  if (!std::isfinite(value)) throw Error(Error::Code::kBadInput, quoted + " is not finite");
  return value;
}

std::vector<double> ParseNumbers(std::string_view text) {
  constexpr std::string_view kSpace = " \t\r\n";
  std::vector<double> numbers;
  std::size_t i = text.find_first_not_of(kSpace);
  while (i != text.npos) {
    const std::size_t end = std::min(text.find_first_of(kSpace, i), text.size());
    numbers.push_back(ParseNumber(text.substr(i, end - i)));
    i = text.find_first_not_of(kSpace, end);
  }
  return numbers;
}

std::string ListNames(const std::vector<std::string>& names, std::size_t limit) {
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), limit); ++i) {
    text += (i == 0 ? "\"" : ", \"") + names[i] + "\"";
  }
  if (names.size() > limit) text += " and " + std::to_string(names.size() - limit) + " more";
  return text;
}

}  // namespace cguide::numeric::io
