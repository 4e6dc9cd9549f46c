#include <algorithm>
#include <cmath>
#include <limits>
#include <system_error>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/io/file_internal.h"
#include "cguide/numeric/io/yaml_internal.h"

namespace cguide::numeric::io {
namespace {

namespace fs = std::filesystem;

const char* KindName(YamlNode::Kind kind) {
  switch (kind) {
    case YamlNode::Kind::kNull:
      return "nothing";
    case YamlNode::Kind::kScalar:
      return "a single value";
    case YamlNode::Kind::kList:
      return "a list";
    case YamlNode::Kind::kMap:
      return "a map";
  }
  return "";
}

}  // namespace

YamlView::YamlView(const YamlNode& node, fs::path file)
    : node_(&node), file_(std::make_shared<const fs::path>(std::move(file))) {}

YamlView::YamlView(const YamlNode& node, const YamlView& parent, std::string path)
    : node_(&node), file_(parent.file_), path_(std::move(path)) {}

std::string YamlView::Place() const {
  return file_->string() + ":" + std::to_string(node_->line) + ":" + std::to_string(node_->column) +
         (path_.empty() ? "" : ": " + path_);
}

void YamlView::Fail(const std::string& why) const {
  throw Error(Error::Code::kBadInput, Place() + ": " + why);
}

void YamlView::AllowKeys(const std::vector<std::string>& known) const {
  if (!IsMap()) {
    Fail(std::string("a map with the keys ") + Join(known) + " is expected here, not " +
         KindName(node_->kind));
  }
  for (std::size_t i = 0; i < node_->keys.size(); ++i) {
    const std::string& key = node_->keys[i];
    if (std::find(known.begin(), known.end(), key) != known.end()) continue;
    YamlView(node_->items[i], *this, path_.empty() ? key : path_ + "." + key)
        .Fail("the key " + Quote(key) + " is unknown; did you mean \"" + NearestName(key, known) +
              "\"? Known here: " + Join(known));
  }
}

std::optional<YamlView> YamlView::Find(const std::string& key) const {
  if (!IsMap()) Fail(std::string("a map is expected here, not ") + KindName(node_->kind));
  const auto found = std::find(node_->keys.begin(), node_->keys.end(), key);
  if (found == node_->keys.end()) return std::nullopt;
  const YamlNode& value = node_->items[static_cast<std::size_t>(found - node_->keys.begin())];
  return YamlView(value, *this, path_.empty() ? key : path_ + "." + key);
}

YamlView YamlView::Get(const std::string& key) const {
  const std::optional<YamlView> value = Find(key);
  if (!value) Fail("the key \"" + key + "\" is missing; add it");
  return *value;
}

std::vector<std::pair<std::string, YamlView>> YamlView::Entries() const {
  if (!IsMap()) Fail(std::string("a map is expected here, not ") + KindName(node_->kind));
  std::vector<std::pair<std::string, YamlView>> entries;
  for (std::size_t i = 0; i < node_->keys.size(); ++i) {
    const std::string& key = node_->keys[i];
    const std::string path = path_.empty() ? key : path_ + "." + key;
    entries.emplace_back(key, YamlView(node_->items[i], *this, path));
  }
  return entries;
}

std::vector<YamlView> YamlView::Items() const {
  if (!IsList()) Fail(std::string("a list is expected here, not ") + KindName(node_->kind));
  std::vector<YamlView> items;
  for (std::size_t i = 0; i < node_->items.size(); ++i) {
    items.push_back(YamlView(node_->items[i], *this, path_ + "[" + std::to_string(i) + "]"));
  }
  return items;
}

std::string YamlView::Text() const {
  if (!IsText()) Fail(std::string("a word is expected here, not ") + KindName(node_->kind));
  if (node_->text.empty()) Fail("the text is empty");
  return node_->text;
}

bool YamlView::Bool() const {
  const bool yes = IsText() && node_->plain && node_->text == "true";
  const bool no = IsText() && node_->plain && node_->text == "false";
  if (!yes && !no) Fail("write true or false here");
  return yes;
}

double YamlView::Number(double low, double high) const {
  if (!IsText()) Fail(std::string("a number is expected here, not ") + KindName(node_->kind));
  if (!node_->plain) Fail("a number is expected here, not text; remove quotes and tags");
  std::string why;
  const double value = ParseDouble(node_->text, &why);
  if (!why.empty())
    Fail(Quote(node_->text) + " " + why + "; write a decimal such as -0.25 or 1e-3");
  if (value < low || value > high) {
    Fail(node_->text + " is out of range; it must lie in [" + ShortestDouble(low) + ", " +
         ShortestDouble(high) + "]");
  }
  return value;
}

int YamlView::Integer(int low, int high) const {
  const double value = Number(low, high);
  if (value != std::floor(value)) Fail(node_->text + " is no whole number");
  return static_cast<int>(value);
}

Eigen::Vector3d YamlView::Vector3(double limit) const {
  const std::vector<YamlView> items = Items();
  if (items.size() != 3) {
    Fail("three numbers are expected here, not " + std::to_string(items.size()));
  }
  return {items[0].Number(-limit, limit), items[1].Number(-limit, limit),
          items[2].Number(-limit, limit)};
}

std::vector<std::string> YamlView::TextList() const {
  std::vector<std::string> words;
  for (const YamlView& item : Items()) words.push_back(item.Text());
  return words;
}

int YamlView::Choice(const std::vector<std::string>& words) const {
  const std::string text = Text();
  const auto found = std::find(words.begin(), words.end(), text);
  if (found == words.end()) Fail(UnknownWord(text, words));
  return static_cast<int>(found - words.begin());
}

fs::path YamlView::Resolved() const {
  const fs::path named = Text();
  return named.is_absolute() ? named : (file_->parent_path() / named).lexically_normal();
}

fs::path YamlView::File() const {
  const fs::path file = Resolved();
  std::error_code code;
  if (fs::is_directory(file, code)) Fail(file.string() + " is a folder; name a file");
  if (!fs::exists(file, code)) {
    throw Error(Error::Code::kIo, Place() + ": there is no file " + file.string() +
                                      "; paths are relative to the folder of " + file_->string());
  }
  return file;
}

fs::path YamlView::Folder() const {
  const fs::path folder = Resolved();
  std::error_code code;
  if (!fs::is_directory(folder, code)) {
    throw Error(Error::Code::kIo, Place() + ": there is no folder " + folder.string() +
                                      "; paths are relative to the folder of " + file_->string());
  }
  return folder;
}

}  // namespace cguide::numeric::io
