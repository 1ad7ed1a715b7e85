// dcd_head.cpp: whole and cut files in every layout, and heads that contradict themselves.
#include "io/frames/dcd_head.h"

#include "base/error.h"
#include "io/frames/made_dcd.h"
#include "support/test_data.h"

using namespace espdiff;
using namespace espdiff_test;  // NOLINT: a test

namespace {

const std::vector<std::array<std::vector<float>, 3>> kThreeFrames(3, {std::vector<float>{1, 2, 3, 4},
                                                                      {5, 6, 7, 8},
                                                                      {9, 10, 11, 12}});

std::vector<DcdForm> forms() {
  std::vector<DcdForm> all;
  for (int i = 0; i < 32; ++i)
    all.push_back({(i & 1) != 0, (i & 2) != 0, (i & 4) != 0, (i & 8) != 0, (i & 16) != 0 ? 3 : 0, -1});
  return all;
}

}  // namespace

TEST_CASE("a DCD of any layout: its whole frames are counted from its size, and what is missing is told") {
  const ScratchFolder folder;
  for (const DcdForm& form : forms()) {
    const std::string whole = made_dcd(kThreeFrames, form);
    const auto head_of = [&](std::size_t n) {
      return read_dcd_head(folder.write("a.dcd", whole.substr(0, n))).value();
    };
    const DcdHead head = head_of(whole.size());
    CHECK(head.n_atoms == 4);
    CHECK(head.n_promised == 3);
    CHECK(head.n_whole == 3);
    CHECK(head.missing().empty());
    const std::uint64_t n_last = head.n_frame;
    // The last frame lacks its last atoms, or most of it; then it is missing.
    for (const std::size_t lost : {std::size_t{1}, std::size_t{8}, static_cast<std::size_t>(n_last - 1)}) {
      CHECK(head_of(whole.size() - lost).missing() == "is cut off in frame 2 (" + std::to_string(n_last - lost) +
                                                          " of " + std::to_string(n_last) +
                                                          " bytes), and its head promises 3 frames");
    }
    CHECK(head_of(whole.size() - n_last).missing() ==
          "holds 2 of the 3 frames that its head promises: it is cut off, or its run ended early");
  }
}

TEST_CASE("a DCD whose head does not say how many frames there are, or fewer, is whole") {
  const ScratchFolder folder;
  for (const int promised : {0, 2}) {
    DcdForm form;
    form.n_promised = promised;
    CHECK(read_dcd_head(folder.write("a.dcd", made_dcd(kThreeFrames, form)))->missing().empty());
  }
}

TEST_CASE("other files are left to their readers; a head that cannot be is refused") {
  const ScratchFolder folder;
  CHECK_FALSE(read_dcd_head(folder.file("absent.dcd")));
  for (const char* text : {"", "2 30\n 0 0 0\n", "CORD", "a text that is longer than the head of a trajectory"})
    CHECK_FALSE(read_dcd_head(folder.write("a.dcd", text)));
  const std::string whole = made_dcd(kThreeFrames);
  const auto refused = [&](const std::string& bytes) {
    const std::string path = folder.write("a.dcd", bytes);
    const std::string message = message_of([&] { read_dcd_head(path); });
    CHECK(message.rfind(path + ": the head of this DCD ", 0) == 0);
    return message.substr(path.size() + 23);
  };
  CHECK(refused(whole.substr(0, 60)) == "is cut off; copy or write the file again");
  std::string bytes = whole;
  bytes[188] = '\xff';  // of the number of atoms
  bytes[191] = '\xff';
  CHECK(refused(bytes).find("atoms, of which 0 are fixed") != std::string::npos);
  bytes = whole;
  bytes[90] = '\1';
  CHECK(refused(bytes) == "has a record whose two lengths differ; copy or write the file again");
}
