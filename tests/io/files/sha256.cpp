// sha256.cpp: the vectors of FIPS 180-4 (NIST, "SHA-256 examples" and CAVP), and files.
#include "io/files/sha256.h"

#include <doctest/doctest.h>

#include "base/error.h"
#include "support/test_data.h"

using namespace espdiff;
using espdiff_test::message_of;
using espdiff_test::ScratchFolder;

TEST_CASE("published vectors") {
  CHECK(sha256_of("") == "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  CHECK(sha256_of("abc") == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  CHECK(sha256_of("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq") ==
        "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  CHECK(sha256_of("abcdefghbcdefghicdefghijdefghijkefghijklfghijklmghijklmnhijklmnoijklmnopjklmnopqklmnopqrlmnopqrsmnop"
                  "qrstnopqrstu") == "cf5b16a778af8380036ce59e7b0492370b249b11e8f07a51afac45037afee9d1");
  CHECK(sha256_of(std::string(1000000, 'a')) == "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST_CASE("pieces give the hash of the whole, at every length around a block") {
  for (std::size_t n = 50; n < 140; ++n) {
    const std::string text(n, 'q');
    Sha256 hash;
    hash.update(text.data(), n / 3);
    hash.update(text.data() + n / 3, 0);
    hash.update(text.data() + n / 3, n - n / 3);
    CHECK(hash.finish() == sha256_of(text));
  }
}

TEST_CASE("with the processor's instructions and without them the hash is the same") {
  if (!Sha256::has_instructions()) MESSAGE("SKIPPED: this processor has no instructions for SHA-256");
  std::string text;
  for (int n = 0; n < 300; ++n) {
    Sha256 plain(false), chosen;
    plain.update(text.data(), text.size());
    chosen.update(text.data(), text.size());
    CHECK(plain.finish() == chosen.finish());
    text += static_cast<char>(37 * n + 11);
  }
}

TEST_CASE("a file hashes to its content, larger than one chunk and empty") {
  const ScratchFolder folder;
  const std::string text(200001, 'z');
  CHECK(sha256_of_file(folder.write("large", text)) == sha256_of(text));
  CHECK(sha256_of_file(folder.write("empty", "")) == sha256_of(""));
}

TEST_CASE("what is no file is refused") {
  const ScratchFolder folder;
  CHECK_THROWS_AS(sha256_of_file(folder.file("missing")), IoError);
  CHECK(message_of([&] { sha256_of_file(folder.file("missing")); }).find("cannot read: No such file") !=
        std::string::npos);
  CHECK(message_of([&] { sha256_of_file("/dev/null"); }) ==
        "/dev/null: is a pipe or a device; save its content as a file and give that");
  CHECK(message_of([&] { sha256_of_file(folder.file("")); }).find("is a folder, not a file") != std::string::npos);
}
