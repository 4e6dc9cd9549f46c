#include <sys/stat.h>
#include <unistd.h>

#include <thread>

#include "cguide/numeric/io/guide_io.h"
#include "tests/numeric/io/reader_tools.h"

namespace cguide::numeric::io {
namespace {

namespace fs = std::filesystem;

std::size_t FilesIn(const fs::path& folder) {
  return static_cast<std::size_t>(
      std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

TEST_CASE("a file is written whole, replaced whole, and nothing is left beside it") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "guide.json";
  WriteFileAtomically(file, "first");
  CHECK(ReadText(file) == "first");
  const std::string large(3'000'000, 'x');
  WriteFileAtomically(file, large);
  CHECK(ReadText(file) == large);
  WriteFileAtomically(file, "");
  CHECK(ReadText(file) == "");
  CHECK(FilesIn(folder.path()) == 1);
}

TEST_CASE("a reader meanwhile sees the old text or the new one, never a part") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "guide.json";
  const std::string a(200'000, 'a'), b(100'000, 'b');
  WriteFileAtomically(file, a);
  std::thread writer([&] {
    for (int i = 0; i < 40; ++i) WriteFileAtomically(file, i % 2 ? a : b);
  });
  int torn = 0;
  for (int i = 0; i < 200; ++i) {
    const std::string text = ReadText(file);
    torn += text != a && text != b;
  }
  writer.join();
  CHECK(torn == 0);
}

TEST_CASE("failure is an error of input and output and leaves what was there") {
  const TemporaryFolder folder;
  const fs::path kept = folder.Write("kept", "old");
  fs::create_directory(folder.path() / "sub");
  for (const fs::path& file : {folder.path() / "nowhere" / "file", folder.path() / "sub",
                               folder.path() / "kept" / "below", folder.path() / "", fs::path()}) {
    CAPTURE(file.string());
    const auto refusal = RefusalOf([&] { WriteFileAtomically(file, "new"); });
    REQUIRE(refusal);
    CHECK(refusal->code == Error::Code::kIo);
    CHECK(refusal->message.find(file.string()) == 0);
  }
  CHECK(FilesIn(folder.path()) == 2);
  CHECK(ReadText(kept) == "old");
}

TEST_CASE("a folder without permission refuses, and the old file stays") {
  if (geteuid() == 0) return;  // root may write anywhere
  const TemporaryFolder folder;
  const fs::path file = folder.Write("locked/kept", "old");
  fs::permissions(file.parent_path(), fs::perms::owner_read | fs::perms::owner_exec);
  CHECK(RefusalOf([&] { WriteFileAtomically(file, "new"); }));
  fs::permissions(file.parent_path(), fs::perms::owner_all);
  CHECK(ReadText(file) == "old");
}

TEST_CASE("a symbolic link stays one and its target is replaced") {
  const TemporaryFolder folder;
  const fs::path target = folder.Write("target", "old");
  const fs::path link = folder.path() / "link";
  fs::create_symlink("target", link);
  WriteFileAtomically(link, "new");
  CHECK(fs::is_symlink(link));
  CHECK(ReadText(target) == "new");
  CHECK(FilesIn(folder.path()) == 2);
}

TEST_CASE("a device is written in place, and a full one says so") {
  WriteFileAtomically("/dev/null", "text");
  CHECK(fs::is_character_file("/dev/null"));
  const auto refusal = RefusalOf([] { WriteFileAtomically("/dev/full", "text"); });
  REQUIRE(refusal);
  CHECK(refusal->code == Error::Code::kIo);
}

TEST_CASE("a new file has the permissions that the mask leaves, not those of a secret") {
  const TemporaryFolder folder;
  const mode_t old = umask(022);
  WriteFileAtomically(folder.path() / "file", "text");
  umask(old);
  struct stat status {};
  REQUIRE(stat((folder.path() / "file").c_str(), &status) == 0);
  CHECK((status.st_mode & 0777) == 0644);
}

}  // namespace
}  // namespace cguide::numeric::io
