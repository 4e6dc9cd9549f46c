#include <catch2/catch.hpp>
#include <set>

#include "cguide/numeric/io/guide_io.h"

namespace cguide::numeric::io {
namespace {

TEST_CASE("the digest is SHA-256: examples of FIPS 180-4 and its padding boundaries") {
  CHECK(Digest("") == "sha256:e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  CHECK(Digest("abc") == "sha256:ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  CHECK(Digest("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq") ==
        "sha256:248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  CHECK(Digest("abcdefghbcdefghicdefghijdefghijkefghijklfghijklmghijklmn"
               "hijklmnoijklmnopjklmnopqklmnopqrlmnopqrsmnopqrstnopqrstu") ==
        "sha256:cf5b16a778af8380036ce59e7b0492370b249b11e8f07a51afac45037afee9d1");
  CHECK(Digest(std::string(1'000'000, 'a')) ==
        "sha256:cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
  CHECK(Digest(std::string(55, 'x')) ==
        "sha256:d5e285683cd4efc02d021a5c62014694958901005d6f71e89e0989fac77e4072");
  CHECK(Digest(std::string(56, 'x')) ==
        "sha256:04c26261370ee7541549d16dee320c723e3fd14671e66a099afe0a377c16888e");
  CHECK(Digest(std::string(63, 'x')) ==
        "sha256:75220b47218278e656f2013bb8f0c455a25eaf01e86c64924e9d48d89776d6f2");
  CHECK(Digest(std::string(64, 'x')) ==
        "sha256:7ce100971f64e7001e8fe5a51973ecdfe1ced42befe7ee8d5fd6219506b5393c");
  CHECK(Digest(std::string(65, 'x')) ==
        "sha256:9537c5fdf120482f7d58d25e9ed583f52c02b4e304ea814db1633ad565aed7e9");
  CHECK(Digest(std::string(119, 'x')) ==
        "sha256:000b48d4edf0fa7bee3c6236ecd2785baa5db4eeb8bb54341b029e0d9fa5fb0c");
  CHECK(Digest(std::string(120, 'x')) ==
        "sha256:13f05a0b594787f5ecd315edc96141bd3243203d1b7d4f0836f37308b276ba98");
}

TEST_CASE("every single byte of the text matters, zero bytes too") {
  std::set<std::string> seen;
  for (std::size_t length = 0; length < 130; ++length) {
    std::string text(length, '\0');
    seen.insert(Digest(text));
    if (length == 0) continue;
    text[length / 2] = 1;
    seen.insert(Digest(text));
  }
  CHECK(seen.size() == 259);
}

}  // namespace
}  // namespace cguide::numeric::io
