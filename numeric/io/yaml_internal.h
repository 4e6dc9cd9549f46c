#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace cguide::numeric::io {

/** A parsed YAML node. Lines and columns count from 1. */
struct YamlNode {
  enum class Kind { kNull, kScalar, kList, kMap };
  Kind kind = Kind::kNull;
  int line = 0;
  int column = 0;
  std::string text;               ///< of a scalar
  bool plain = true;              ///< a scalar without quotes and without tag
  std::vector<std::string> keys;  ///< of a map, in the file's order, without repeats
  std::vector<YamlNode> items;    ///< of a list, or the values of a map
};

/** How much a document may hold, and what to do about one that holds more. */
struct YamlLimits {
  long nodes = 200'000;  ///< aliases expanded, anchored nodes twice
  const char* remedy = "put large geometry into mesh files";
};

/** Parses one document. Repeated keys, keys that are no scalars, more than one document, nesting
 deeper than 32, more nodes than the limit and aliases to an enclosing node are refused. `place` is
 the file's name for messages. @throws Error (kBadInput) with place:line:column. */
YamlNode ParseYaml(const std::string& text, const std::string& place,
                   const YamlLimits& limits = {});

/** A node together with the file and the key path that lead to it: the cursor all of the problem
 reader works with. Every refusal throws Error (kBadInput) "file:line:column: key.path: why". Cheap
 to copy; borrows the tree. */
class YamlView {
 public:
  YamlView(const YamlNode& node, std::filesystem::path file);

  [[noreturn]] void Fail(const std::string& why) const;
  /** "file:line:column: key.path", for messages of others. */
  std::string Place() const;
  const std::string& path() const { return path_; }

  bool IsText() const { return node_->kind == YamlNode::Kind::kScalar; }
  bool IsList() const { return node_->kind == YamlNode::Kind::kList; }
  bool IsMap() const { return node_->kind == YamlNode::Kind::kMap; }

  /** Refuses keys that are not in the list and names the nearest that is. */
  void AllowKeys(const std::vector<std::string>& known) const;
  std::optional<YamlView> Find(const std::string& key) const;
  YamlView Get(const std::string& key) const;
  /** Keys and values of a map, in the file's order. */
  std::vector<std::pair<std::string, YamlView>> Entries() const;
  std::vector<YamlView> Items() const;

  std::string Text() const;
  bool Bool() const;
  /** A finite number in [low, high]; a quoted one is text and refused. */
  double Number(double low, double high) const;
  int Integer(int low, int high) const;
  /** A list of three numbers with |x| <= limit. */
  Eigen::Vector3d Vector3(double limit) const;
  std::vector<std::string> TextList() const;
  /** One of the words, by index. */
  int Choice(const std::vector<std::string>& words) const;
  /** A path to an existing file, relative to the folder of this YAML file. */
  std::filesystem::path File() const;
  /** Likewise, but a folder. */
  std::filesystem::path Folder() const;

 private:
  YamlView(const YamlNode& node, const YamlView& parent, std::string path);
  std::filesystem::path Resolved() const;

  const YamlNode* node_;
  std::shared_ptr<const std::filesystem::path> file_;
  std::string path_;
};

}  // namespace cguide::numeric::io
