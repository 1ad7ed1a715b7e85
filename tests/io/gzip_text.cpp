// gzip_text.cpp: whole text files, plain and by gzip, and the files that cannot be read.
#include "io/gzip_text.h"

#if defined(ESPDIFF_HAVE_ZLIB)
#include <zlib.h>
#endif

#include "base/error.h"
#include "support/test_data.h"

using namespace espdiff;
using namespace espdiff_test;

namespace {

#if defined(ESPDIFF_HAVE_ZLIB)
/// One gzip member.
std::string gzip(const std::string& text) {
  z_stream stream{};
  REQUIRE(deflateInit2(&stream, 9, Z_DEFLATED, 16 + MAX_WBITS, 9, Z_DEFAULT_STRATEGY) == Z_OK);
  std::string packed(deflateBound(&stream, text.size()) + 32, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
  stream.avail_in = static_cast<uInt>(text.size());
  stream.next_out = reinterpret_cast<Bytef*>(&packed[0]);
  stream.avail_out = static_cast<uInt>(packed.size());
  REQUIRE(deflate(&stream, Z_FINISH) == Z_STREAM_END);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  return packed;
}

std::string long_text() {
  std::string text;
  for (int i = 0; i < 200000; ++i) text += std::to_string(i) + "\n";
  return text;
}
#endif

}  // namespace

#if defined(ESPDIFF_HAVE_ZLIB)

TEST_CASE("gzip_text: plain and packed files give the same text, whatever their name") {
  const ScratchFolder scratch;
  const std::string text = long_text();
  CHECK(read_text_file(scratch.write("plain.gz", text)) == text);
  CHECK(read_text_file(scratch.write("packed.txt", gzip(text))) == text);
  CHECK(is_gzip_file(scratch.file("packed.txt")));
  CHECK_FALSE(is_gzip_file(scratch.file("plain.gz")));
}

TEST_CASE("gzip_text: members joined by cat are read through, padding behind them is not") {
  const ScratchFolder scratch;
  CHECK(read_text_file(scratch.write("two.gz", gzip("one\n") + gzip("two\n"))) == "one\ntwo\n");
  CHECK(read_text_file(scratch.write("padded.gz", gzip("one\n") + std::string(512, '\0'))) == "one\n");
}

TEST_CASE("gzip_text: peeking returns the beginning") {
  const ScratchFolder scratch;
  const std::string text = long_text();
  CHECK(peek_text_file(scratch.write("plain", text), 100) == text.substr(0, 100));
  CHECK(peek_text_file(scratch.write("packed", gzip(text)), 700000) == text.substr(0, 700000));
  CHECK(peek_text_file(scratch.write("short", "abc"), 100) == "abc");
}

TEST_CASE("gzip_text: damaged gzip files are refused") {
  const ScratchFolder scratch;
  const std::string packed = gzip(long_text());
  const std::string cut = scratch.write("cut.gz", packed.substr(0, packed.size() / 2));
  CHECK(message_of([&] { read_text_file(cut); }).find("cut.gz: the gzip file ends early, after ") != std::string::npos);
  CHECK_THROWS_AS(read_text_file(cut), FormatError);
  std::string corrupt = packed;
  for (std::size_t i = 2000; i < 2100; ++i) corrupt[i] = static_cast<char>(~corrupt[i]);
  CHECK_THROWS_AS(read_text_file(scratch.write("corrupt.gz", corrupt)), FormatError);
  // The checksum and length at the end must be there and right, too.
  CHECK_THROWS_AS(read_text_file(scratch.write("tail.gz", packed.substr(0, packed.size() - 3))), FormatError);
  std::string wrong_sum = packed;
  wrong_sum[packed.size() - 6] = static_cast<char>(~wrong_sum[packed.size() - 6]);
  CHECK_THROWS_AS(read_text_file(scratch.write("sum.gz", wrong_sum)), FormatError);
  CHECK_THROWS_AS(read_text_file(scratch.write("empty.gz", gzip(""))), InputError);
}

#else

TEST_CASE("gzip_text: without zlib a compressed file is refused with the remedy") {
  MESSAGE("SKIPPED: this build has no zlib: compressed files are refused");
  const ScratchFolder scratch;
  const std::string path = scratch.write("packed.gz", std::string("\x1f\x8b\x08", 3) + std::string(40, '\0'));
  CHECK(is_gzip_file(path));
  CHECK(message_of([&] { read_text_file(path); }).find("this build has no zlib") != std::string::npos);
}

#endif

TEST_CASE("gzip_text: old Mac line ends become newlines, others stay") {
  const ScratchFolder scratch;
  CHECK(read_text_file(scratch.write("mac", "a\rb\r")) == "a\nb\n");
  CHECK(read_text_file(scratch.write("dos", "a\r\nb\r\n")) == "a\r\nb\r\n");
}

TEST_CASE("gzip_text: what is no readable file says so") {
  const ScratchFolder scratch;
  CHECK(message_of([&] { read_text_file(scratch.file("absent")); }) ==
        scratch.file("absent") + ": cannot be read: No such file or directory; check the path");
  CHECK_THROWS_AS(read_text_file(scratch.file("absent")), IoError);
  CHECK(message_of([&] { read_text_file(scratch.file("")); }) ==
        scratch.file("") + ": is a directory; give a file in it");
  CHECK_THROWS_AS(read_text_file(scratch.file("")), IoError);
  const std::string empty = scratch.write("empty", "");
  CHECK(message_of([&] { read_text_file(empty); }) == empty + ": is empty; give a file with content");
  CHECK_THROWS_AS(read_text_file(empty), InputError);
}
