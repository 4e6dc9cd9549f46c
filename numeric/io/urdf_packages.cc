#include <tinyxml2.h>

#include <vector>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/io/urdf_packages_internal.h"
#include "cguide/numeric/io/urdf_xml_internal.h"

namespace cguide::numeric::io {
namespace {

namespace fs = std::filesystem;

bool IsFile(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

// The name a package.xml gives itself, empty where there is none.
std::string PackageName(const fs::path& manifest) {
  tinyxml2::XMLDocument document;
  if (!IsFile(manifest) || document.LoadFile(manifest.c_str()) != tinyxml2::XML_SUCCESS) return {};
  const auto* root = document.RootElement();
  const auto* name = root == nullptr ? nullptr : root->FirstChildElement("name");
  return name == nullptr || name->GetText() == nullptr ? "" : name->GetText();
}

[[noreturn]] void RefuseMissing(const std::string& uri, const std::string& place,
                                const std::vector<fs::path>& tried, const std::string& remedy) {
  constexpr std::size_t kShown = 8;
  std::string text = place + ": \"" + uri + "\" is not found; tried";
  for (std::size_t i = 0; i < std::min(tried.size(), kShown); ++i) {
    text += (i == 0 ? " " : ", ") + tried[i].string();
  }
  if (tried.size() > kShown) text += " and the folders above";
  throw Error(Error::Code::kIo, text + "; " + remedy);
}

fs::path ResolvePackage(const std::string& uri, std::string_view name_and_rest,
                        const fs::path& mentioned_in, const PackageMap& packages,
                        const std::string& place) {
  while (name_and_rest.starts_with('/')) name_and_rest.remove_prefix(1);
  const std::size_t slash = name_and_rest.find('/');
  if (slash == std::string_view::npos || slash + 1 == name_and_rest.size()) {
    throw Error(Error::Code::kBadInput,
                place + ": \"" + uri + "\" names no file; write package://NAME/path");
  }
  const std::string name(name_and_rest.substr(0, slash));
  // Made relative, so that a doubled slash does not turn it into an absolute path.
  const fs::path rest = fs::path(name_and_rest.substr(slash + 1)).relative_path();
  std::vector<fs::path> tried;
  const auto Try = [&tried](const fs::path& candidate) {
    tried.push_back(candidate);
    return IsFile(candidate);
  };
  if (const auto listed = packages.find(name); listed != packages.end()) {
    if (Try(listed->second / rest)) return tried.back();
    RefuseMissing(uri, place, tried, "correct the folder given for package \"" + name + "\"");
  }
  fs::path folder = fs::absolute(mentioned_in).lexically_normal().parent_path();
  while (true) {
    if (Try(folder / name / rest)) return tried.back();
    if (PackageName(folder / "package.xml") == name && Try(folder / rest)) return tried.back();
    if (folder == folder.parent_path()) break;
    folder = folder.parent_path();
  }
  RefuseMissing(uri, place, tried, "say where package \"" + name + "\" is (robot.packages)");
}

}  // namespace

fs::path ResolveUri(const std::string& uri, const fs::path& mentioned_in,
                    const PackageMap& packages, const std::string& place) {
  const std::string_view text = uri;
  for (const std::string_view scheme : {"package://", "model://"}) {
    if (text.starts_with(scheme)) {
      return ResolvePackage(uri, text.substr(scheme.size()), mentioned_in, packages, place);
    }
  }
  constexpr std::string_view kFileScheme = "file://";
  fs::path path = text.starts_with(kFileScheme) ? text.substr(kFileScheme.size()) : text;
  if (!text.starts_with(kFileScheme) && text.find("://") != std::string_view::npos) {
    throw Error(Error::Code::kBadInput, place + ": \"" + uri +
                                            "\" has an unknown scheme; use package://, file:// or "
                                            "a path");
  }
  if (path.is_relative()) path = mentioned_in.parent_path() / path;
  if (!IsFile(path)) RefuseMissing(uri, place, {path}, "check the path");
  return path;
}

}  // namespace cguide::numeric::io
