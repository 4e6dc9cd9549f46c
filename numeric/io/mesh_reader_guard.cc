#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <vector>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/io/mesh_reader_guard_internal.h"
#include "cguide/numeric/io/urdf_xml_internal.h"

namespace cguide::numeric::io {
namespace {

[[noreturn]] void Refuse(const std::string& place, const std::string& what) {
  throw Error(Error::Code::kBadInput, place + ": " + what);
}

[[noreturn]] void RefuseLine(const std::string& place, std::size_t line, const std::string& what) {
  Refuse(place + ":" + std::to_string(line), what);
}

// Words of a text line by line; a word is what stands between white space.
class Lines {
 public:
  explicit Lines(std::string_view text) : text_(text) {}
  bool Next() {
    if (text_.empty()) return false;
    const std::size_t end = text_.find('\n');
    line_ = text_.substr(0, end);
    text_ = end == std::string_view::npos ? std::string_view() : text_.substr(end + 1);
    ++number_;
    return true;
  }
  std::size_t number() const { return number_; }
  std::vector<std::string_view> Words() const {
    std::vector<std::string_view> words;
    constexpr std::string_view kSpace = " \t\r\v\f";
    std::size_t i = line_.find_first_not_of(kSpace);
    while (i != std::string_view::npos && line_[i] != '#') {
      const std::size_t end = std::min(line_.find_first_of(kSpace, i), line_.size());
      words.push_back(line_.substr(i, end - i));
      i = line_.find_first_not_of(kSpace, end);
    }
    return words;
  }

 private:
  std::string_view text_;
  std::string_view line_;
  std::size_t number_ = 0;
};

using Word = std::vector<std::string_view>::const_iterator;

void AppendLine(Word begin, Word end, std::string* text) {
  for (Word word = begin; word != end; ++word) {
    if (word != begin) *text += ' ';
    *text += *word;
  }
  *text += '\n';
}

void CheckCoordinates(Word begin, Word end, const std::string& place, std::size_t line) {
  if (end - begin < 3) RefuseLine(place, line, "a vertex without three coordinates");
  ReadAt(place + ":" + std::to_string(line), [&] {
    for (Word word = begin; word != begin + 3; ++word) ParseNumber(*word);
  });
}

// -1 where the word is no integer.
long ReadInteger(std::string_view word) {
  long value = 0;
  const auto [stop, status] = std::from_chars(word.data(), word.data() + word.size(), value);
  return status == std::errc() && stop == word.data() + word.size() ? value : -1;
}

// ---- STL ----

constexpr std::size_t kStlHeader = 84, kStlTriangle = 50;

// Solids of facets of three vertices, one keyword a line; normals and names are not looked at.
std::string ObjFromTextStl(const std::string& bytes, const std::string& place) {
  static constexpr std::string_view kFacet[] = {"facet",  "outer",   "vertex",  "vertex",
                                                "vertex", "endloop", "endfacet"};
  std::string plain;
  std::size_t vertices = 0;
  std::size_t step = 0;  // within a facet
  bool inside = false;   // a solid
  Lines lines(bytes);
  while (lines.Next()) {
    const auto words = lines.Words();
    if (words.empty()) continue;
    if (step == 0 && words[0] == (inside ? "endsolid" : "solid")) {
      inside = !inside;
      continue;
    }
    if (!inside || words[0] != kFacet[step]) {
      RefuseLine(place, lines.number(),
                 "text STL with \"" + std::string(words[0]) + "\" where \"" +
                     std::string(inside ? kFacet[step] : "solid") + "\" should stand");
    }
    if (words[0] == "vertex") {
      CheckCoordinates(words.begin() + 1, words.end(), place, lines.number());
      plain += "v ";
      AppendLine(words.begin() + 1, words.begin() + 4, &plain);
      ++vertices;
    }
    step = (step + 1) % std::size(kFacet);
    if (step != 0) continue;
    for (std::size_t back : {2, 1, 0}) {
      plain += (back == 2 ? "f " : " ") + std::to_string(vertices - back);
    }
    plain += '\n';
  }
  if (inside) {
    RefuseLine(place, lines.number(), "text STL without its last endsolid: it is truncated");
  }
  if (vertices == 0) Refuse(place, "text STL without facets");
  return plain;
}

GuardedMesh GuardStl(std::string bytes, const std::string& place) {
  std::uint64_t announced = 0;
  if (bytes.size() >= kStlHeader) {
    std::uint32_t count = 0;  // little-endian, as this machine must be
    std::memcpy(&count, bytes.data() + kStlHeader - sizeof(count), sizeof(count));
    announced = kStlHeader + kStlTriangle * std::uint64_t{count};
    // Binary files may begin with "solid" too; the size decides.
    if (announced == bytes.size()) return {std::move(bytes), "stl"};
  }
  if (bytes.starts_with("solid") && bytes.find('\0') == std::string::npos) {
    return {ObjFromTextStl(bytes, place), "obj"};
  }
  Refuse(place, "no text STL, and as binary STL it must have " +
                    std::to_string(announced > 0 ? announced : kStlHeader) + " bytes, not " +
                    std::to_string(bytes.size()) + ": it is truncated or no STL at all");
}

// ---- OFF ----

std::vector<std::string_view> NextWords(Lines* lines, const std::string& place) {
  while (lines->Next()) {
    auto words = lines->Words();
    if (!words.empty()) return words;
  }
  Refuse(place, "the file ends before its last face: it is truncated");
}

// Counts, three coordinates a vertex and the corners of the faces, without comments and colours.
std::string PlainOff(const std::string& bytes, const std::string& place) {
  Lines lines(bytes);
  auto words = NextWords(&lines, place);
  if (words[0] != "OFF")
    RefuseLine(place, lines.number(), "the first word is not OFF; use plain OFF");
  words.erase(words.begin());
  if (words.empty()) words = NextWords(&lines, place);
  const long vertices = ReadInteger(words[0]);
  const long faces = words.size() < 2 ? -1 : ReadInteger(words[1]);
  // Each vertex and each face takes a line, at least one byte each.
  const long size = static_cast<long>(bytes.size());
  if (vertices < 0 || faces < 0 || vertices > size || faces > size) {
    RefuseLine(place, lines.number(), "the counts of vertices and faces are missing or too large");
  }
  std::string plain = "OFF\n" + std::to_string(vertices) + " " + std::to_string(faces) + " 0\n";
  for (long i = 0; i < vertices; ++i) {
    words = NextWords(&lines, place);
    CheckCoordinates(words.begin(), words.end(), place, lines.number());
    AppendLine(words.begin(), words.begin() + 3, &plain);
  }
  for (long i = 0; i < faces; ++i) {
    words = NextWords(&lines, place);
    const long corners = ReadInteger(words[0]);
    if (corners < 3 || corners >= static_cast<long>(words.size())) {
      RefuseLine(place, lines.number(), "a face with fewer than three corners or too few indices");
    }
    for (long c = 1; c <= corners; ++c) {
      const long index = ReadInteger(words[c]);
      if (index < 0 || index >= vertices) {
        RefuseLine(place, lines.number(),
                   "a face names vertex " + std::string(words[c]) + ", but the vertices are 0 to " +
                       std::to_string(vertices - 1));
      }
    }
    AppendLine(words.begin(), words.begin() + corners + 1, &plain);
  }
  return plain;
}

// ---- OBJ ----

// Vertices and faces in their order, without normals, textures, groups and materials. Corners are
// i, i/t, i//n or i/t/n; negative i counts back from the latest vertex.
std::string PlainObj(const std::string& bytes, const std::string& place) {
  std::string plain;
  long vertices = 0, faces = 0;
  Lines lines(bytes);
  while (lines.Next()) {
    const auto words = lines.Words();
    if (words.empty()) continue;
    if (words.back() == "\\")
      RefuseLine(place, lines.number(), "continued lines are not supported");
    if (words[0] == "v") {
      CheckCoordinates(words.begin() + 1, words.end(), place, lines.number());
      ++vertices;
      AppendLine(words.begin(), words.begin() + 4, &plain);
    }
    if (words[0] != "f") continue;
    if (words.size() < 4) RefuseLine(place, lines.number(), "a face with fewer than three corners");
    ++faces;
    plain += "f";
    for (std::size_t c = 1; c < words.size(); ++c) {
      const std::string_view corner = words[c].substr(0, words[c].find('/'));
      const bool backwards = corner.starts_with('-');
      const long number = ReadInteger(backwards ? corner.substr(1) : corner);
      const long index = backwards ? vertices + 1 - number : number;
      if (number < 1 || index < 1 || index > vertices) {
        RefuseLine(place, lines.number(),
                   "a face names vertex " + std::string(corner) +
                       ", but the vertices so far are 1 to " + std::to_string(vertices));
      }
      plain += " " + std::to_string(index);
    }
    plain += "\n";
  }
  if (faces == 0) Refuse(place, "OBJ without faces");
  return plain;
}

}  // namespace

GuardedMesh GuardMesh(std::string bytes, MeshFormat format, const std::string& place) {
  switch (format) {
    case MeshFormat::kStl:
      return GuardStl(std::move(bytes), place);
    case MeshFormat::kOff:
      return {PlainOff(bytes, place), "off"};
    case MeshFormat::kObj:
      return {PlainObj(bytes, place), "obj"};
    case MeshFormat::kDae:
      return {PlainObj(ObjFromDae(bytes, place), place), "obj"};
  }
  Refuse(place, "unknown mesh format");
}

}  // namespace cguide::numeric::io
