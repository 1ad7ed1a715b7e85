// read_input.cpp: whole files, plain and by gzip, from disk and through pipes, with their hash; and what cannot be
// read.
#include "io/files/read_input.h"

#if defined(ESPDIFF_HAVE_ZLIB)
#include <zlib.h>
#endif

#include <sys/stat.h>

#include <cstdint>
#include <thread>

#include "base/error.h"
#include "io/files/sha256.h"
#include "io/grids/read_grid.h"
#include "io/structures/structure_file.h"
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

TEST_CASE("read_input: plain and packed files give the same text, whatever their name") {
  const ScratchFolder scratch;
  const std::string text = long_text();
  CHECK(read_text_file(scratch.write("plain.gz", text)) == text);
  CHECK(read_text_file(scratch.write("packed.txt", gzip(text))) == text);
  // The hash is of the file as it stands, as `sha256sum` prints it.
  CHECK(read_input(scratch.file("plain.gz")).sha256 == sha256_of(text));
  CHECK(read_input(scratch.file("packed.txt")).sha256 == sha256_of(gzip(text)));
  CHECK(read_input(scratch.file("packed.txt")).content == text);
}

TEST_CASE("read_input: members joined by cat are read through, padding behind them is not") {
  const ScratchFolder scratch;
  CHECK(read_text_file(scratch.write("two.gz", gzip("one\n") + gzip("two\n"))) == "one\ntwo\n");
  CHECK(read_text_file(scratch.write("padded.gz", gzip("one\n") + std::string(512, '\0'))) == "one\n");
}

TEST_CASE("read_input: members and padding that begin anywhere in a chunk") {
  const ScratchFolder scratch;
  // Incompressible, so that the first member ends at about the border of the chunks that files are read in.
  std::string noise;
  std::uint32_t state = 1;
  while (noise.size() < (std::size_t{1} << 18) - 64) {
    state = state * 1664525U + 1013904223U;
    noise += static_cast<char>(state >> 24U);
  }
  for (int more = 0; more < 64; ++more) {
    noise += 'x';
    CAPTURE(more);
    CHECK(read_text_file(scratch.write("two.gz", gzip(noise) + gzip("two\n"))) == noise + "two\n");
  }
}

TEST_CASE("read_input: the beginning is looked at once, before the rest is read") {
  const ScratchFolder scratch;
  const std::string text = long_text();
  for (const std::string& path : {scratch.write("plain", text), scratch.write("packed", gzip(text))}) {
    int looks = 0;
    const FileContent file = read_input(path, [&](std::string_view head) {
      ++looks;
      CHECK(head == std::string_view(text).substr(0, 65536));
    });
    CHECK(looks == 1);
    CHECK(file.content == text);
  }
  read_input(scratch.write("short", "abc"), [](std::string_view head) { CHECK(head == "abc"); });
  // A file that is refused by its beginning is not read on: this one is damaged behind it.
  const std::string packed = gzip(long_text());
  CHECK(message_of([&] {
          read_input(scratch.write("cut.gz", packed.substr(0, packed.size() / 2)),
                     [](std::string_view) { throw InputError("another kind"); });
        }) == "another kind");
}

TEST_CASE("read_input: damaged gzip files are refused") {
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

TEST_CASE("read_input: without zlib a compressed file is refused with the remedy") {
  MESSAGE("SKIPPED: this build has no zlib: compressed files are refused");
  const ScratchFolder scratch;
  const std::string path = scratch.write("packed.gz", std::string("\x1f\x8b\x08", 3) + std::string(40, '\0'));
  CHECK(message_of([&] { read_text_file(path); }).find("this build has no zlib") != std::string::npos);
}

#endif

TEST_CASE("read_input: old Mac line ends become newlines, others stay") {
  const ScratchFolder scratch;
  CHECK(read_text_file(scratch.write("mac", "a\rb\r")) == "a\nb\n");
  CHECK(read_text_file(scratch.write("dos", "a\r\nb\r\n")) == "a\r\nb\r\n");
}

TEST_CASE("read_input: a pipe is read once, to its end") {
  const ScratchFolder scratch;
  const std::string path = scratch.file("pipe");
  REQUIRE(mkfifo(path.c_str(), 0600) == 0);
  std::string text(300000, 'a');
  text.back() = '\n';
  std::thread writer([&] { std::ofstream(path, std::ios::binary) << text; });
  const FileContent file = read_input(path);
  writer.join();
  CHECK(file.content == text);
  CHECK(file.sha256 == sha256_of(text));
}

TEST_CASE("read_input: what is read is what is hashed, whatever becomes of the file") {
  const ScratchFolder scratch;
  const std::string before = "ATOM      1  CA  ALA A   1       1.000   2.000   3.000  0.5000 2.0000\n",
                    after = "ATOM      1  CA  ALA A   1       9.000   2.000   3.000  0.5000 2.0000\n";
  const std::string path = scratch.write("a.pqr", before);
  const StructureFile file(path);
  scratch.write("a.pqr", after);
  CHECK(file.read({}).positions[0].x == 1);
  CHECK(file.sha256() == sha256_of(before));
  CHECK(StructureFile(path).sha256() == sha256_of(after));
}

TEST_CASE("read_input: a map and its hash come from one reading, packed or not") {
  const ScratchFolder scratch;
  const std::string dx =
      "object 1 class gridpositions counts 2 2 2\norigin 0 0 0\ndelta 1 0 0\ndelta 0 1 0\ndelta 0 0 1\n"
      "object 2 class gridconnections counts 2 2 2\n"
      "object 3 class array type double rank 0 items 8 data follows\n1 2 3 4 5 6 7 8\n";
  const GridFile plain = read_grid_file(scratch.write("a.dx", dx));
  CHECK(plain.grid.values.back() == 8);
  CHECK(plain.sha256 == sha256_of(dx));
}

TEST_CASE("read_input: what is no readable file says so") {
  const ScratchFolder scratch;
  CHECK(message_of([&] { read_text_file(scratch.file("absent")); }) ==
        scratch.file("absent") + ": cannot be read: No such file or directory; check the path");
  CHECK_THROWS_AS(read_text_file(scratch.file("absent")), IoError);
  CHECK(message_of([&] { read_text_file(scratch.file("")); }) ==
        scratch.file("") + ": is a directory; give a file in it");
  CHECK_THROWS_AS(read_text_file(scratch.file("")), IoError);
  CHECK(message_of([&] { read_text_file("/dev/null"); }) ==
        "/dev/null: is a device or a socket; give a file or a pipe");
  const std::string empty = scratch.write("empty", "");
  CHECK(message_of([&] { read_text_file(empty); }) == empty + ": is empty; give a file with content");
  CHECK_THROWS_AS(read_text_file(empty), InputError);
}
