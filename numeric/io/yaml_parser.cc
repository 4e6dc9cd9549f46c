#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/mark.h>
#include <yaml-cpp/parser.h>

#include <map>
#include <set>
#include <sstream>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/io/file_internal.h"
#include "cguide/numeric/io/yaml_internal.h"

namespace cguide::numeric::io {
namespace {

constexpr std::size_t kMaxDepth = 32;

long CountNodes(const YamlNode& node) {
  long count = 1;
  for (const YamlNode& item : node.items) count += CountNodes(item);
  return count;
}

// Builds the tree from the parser's events rather than from YAML::Node, which keeps the first of
// two equal keys silently, shares alias targets (a small file can then unfold without bound) and
// recurses.
class TreeBuilder : public YAML::EventHandler {
 public:
  TreeBuilder(std::string place, const YamlLimits& limits)
      : place_(std::move(place)), limits_(limits) {}

  YamlNode TakeRoot() { return std::move(root_); }

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    YamlNode node = MakeNode(YamlNode::Kind::kNull, mark);
    Finish(std::move(node), anchor);
  }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    YamlNode node = MakeNode(YamlNode::Kind::kScalar, mark);
    node.text = value;
    node.plain = tag.empty() || tag == "?";
    Finish(std::move(node), anchor);
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const auto target = anchors_.find(anchor);
    if (target == anchors_.end()) {
      Refuse(mark, "an alias stands inside the node it names; write the value out");
    }
    YamlNode copy = target->second;
    nodes_ += CountNodes(copy);
    CheckSize(mark.line + 1, mark.column + 1);
    copy.line = mark.line + 1;
    copy.column = mark.column + 1;
    Finish(std::move(copy), YAML::NullAnchor);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    Open(YamlNode::Kind::kList, mark, anchor);
  }
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    Open(YamlNode::Kind::kMap, mark, anchor);
  }
  void OnSequenceEnd() override { Close(); }
  void OnMapEnd() override { Close(); }

 private:
  struct Frame {
    YamlNode node;
    YAML::anchor_t anchor;
    std::set<std::string> keys;
  };

  [[noreturn]] void Refuse(int line, int column, const std::string& why) const {
    throw Error(Error::Code::kBadInput,
                place_ + ":" + std::to_string(line) + ":" + std::to_string(column) + ": " + why);
  }
  [[noreturn]] void Refuse(const YAML::Mark& mark, const std::string& why) const {
    Refuse(mark.line + 1, mark.column + 1, why);
  }

  void CheckSize(int line, int column) const {
    if (nodes_ > limits_.nodes) {
      Refuse(line, column,
             "the file holds more than " + std::to_string(limits_.nodes) +
                 " values, aliases counted; " + limits_.remedy);
    }
  }

  YamlNode MakeNode(YamlNode::Kind kind, const YAML::Mark& mark) {
    ++nodes_;
    CheckSize(mark.line + 1, mark.column + 1);
    YamlNode node;
    node.kind = kind;
    node.line = mark.line + 1;
    node.column = mark.column + 1;
    return node;
  }

  void Open(YamlNode::Kind kind, const YAML::Mark& mark, YAML::anchor_t anchor) {
    if (stack_.size() >= kMaxDepth) {
      Refuse(mark, "nested deeper than " + std::to_string(kMaxDepth) + " levels; no such file is");
    }
    YamlNode node = MakeNode(kind, mark);
    if (ExpectsKey()) RefuseKey(node);
    stack_.push_back({std::move(node), anchor, {}});
  }

  void Close() {
    Frame frame = std::move(stack_.back());
    stack_.pop_back();
    Finish(std::move(frame.node), frame.anchor);
  }

  bool ExpectsKey() const {
    return !stack_.empty() && stack_.back().node.kind == YamlNode::Kind::kMap &&
           stack_.back().node.keys.size() == stack_.back().node.items.size();
  }

  [[noreturn]] void RefuseKey(const YamlNode& key) const {
    Refuse(key.line, key.column,
           "a key must be a word, not a list, a map or nothing; is a bracket or the rest missing?");
  }

  void Finish(YamlNode node, YAML::anchor_t anchor) {
    if (anchor != YAML::NullAnchor) {
      // The copy counts, or anchors one inside the other would multiply the memory by their depth.
      nodes_ += CountNodes(node);
      CheckSize(node.line, node.column);
      anchors_[anchor] = node;
    }
    if (stack_.empty()) {
      root_ = std::move(node);
      return;
    }
    YamlNode& parent = stack_.back().node;
    if (!ExpectsKey()) {
      parent.items.push_back(std::move(node));
      return;
    }
    if (node.kind != YamlNode::Kind::kScalar) RefuseKey(node);
    if (!stack_.back().keys.insert(node.text).second) {
      Refuse(node.line, node.column,
             "the key " + Quote(node.text) + " stands twice in this map; keep one of them");
    }
    parent.keys.push_back(std::move(node.text));
  }

  std::string place_;
  YamlLimits limits_;
  YamlNode root_;
  std::vector<Frame> stack_;
  std::map<YAML::anchor_t, YamlNode> anchors_;
  long nodes_ = 0;
};

}  // namespace

YamlNode ParseYaml(const std::string& text, const std::string& place, const YamlLimits& limits) {
  try {
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    TreeBuilder builder(place, limits);
    if (!parser.HandleNextDocument(builder)) {
      throw Error(Error::Code::kBadInput, place + ": the file holds no value; is it empty?");
    }
    TreeBuilder second(place, limits);
    if (parser.HandleNextDocument(second)) {
      throw Error(Error::Code::kBadInput,
                  place + ": the file holds more than one YAML document (a line ---); keep one");
    }
    return builder.TakeRoot();
  } catch (const YAML::Exception& e) {
    const std::string where = e.mark.is_null() ? ""
                                               : ":" + std::to_string(e.mark.line + 1) + ":" +
                                                     std::to_string(e.mark.column + 1);
    throw Error(Error::Code::kBadInput, place + where + ": this is not YAML (" + e.msg +
                                            "); check brackets, quotes and indentation");
  }
}

}  // namespace cguide::numeric::io
