// baselines.cpp: a few small pictures against baselines accepted by eye (tests/view/baselines).
//
// ESPDIFF_WRITE_BASELINES=1 rewrites them; look at each before you keep it.
#include <doctest/doctest.h>
#include <vtkPNGWriter.h>

#include <cstdlib>
#include <filesystem>

#include "view/decoded_picture.h"
#include "view/display_here.h"
#include "view/made_comparison.h"
#include "view/render_surface.h"

using namespace espdiff;  // NOLINT: a test of one header
using espdiff_test::Picture;
using espdiff_test::ScratchFolder;

namespace {

const std::string kFolder = ESPDIFF_SOURCE_DIR "/tests/view/baselines/";

struct Difference {
  double mean = 0;       ///< of the channels' absolute differences, 0 to 255
  double far_share = 0;  ///< fraction of pixels that differ by more than 48 in a channel
};

Difference difference(const Picture& a, const Picture& b) {
  REQUIRE(a.width() == b.width());
  REQUIRE(a.height() == b.height());
  Difference sum;
  for (int y = 0; y < a.height(); ++y) {
    for (int x = 0; x < a.width(); ++x) {
      int worst = 0;
      for (int channel = 0; channel < 3; ++channel) {
        const int off = std::abs(a.pixel(x, y)[channel] - b.pixel(x, y)[channel]);
        sum.mean += off / 3.0;
        worst = std::max(worst, off);
      }
      sum.far_share += worst > 48 ? 1 : 0;
    }
  }
  const double n = static_cast<double>(a.width()) * a.height();
  return {sum.mean / n, sum.far_share / n};
}

/// A quarter of the pixels, to keep baselines small.
std::string halved(const Picture& picture, const std::string& path) {
  vtkNew<vtkImageData> half;
  half->SetDimensions(picture.width() / 2, picture.height() / 2, 1);
  half->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  for (int y = 0; y < picture.height() / 2; ++y) {
    for (int x = 0; x < picture.width() / 2; ++x) {
      auto* to = static_cast<unsigned char*>(half->GetScalarPointer(x, y, 0));
      for (int channel = 0; channel < 3; ++channel) {
        int sum = 0;
        for (int corner = 0; corner < 4; ++corner)
          sum += picture.pixel(2 * x + corner % 2, 2 * y + corner / 2)[channel];
        to[channel] = static_cast<unsigned char>((sum + 2) / 4);
      }
    }
  }
  vtkNew<vtkPNGWriter> writer;
  writer->SetInputData(half);
  writer->SetFileName(path.c_str());
  writer->SetCompressionLevel(9);
  writer->Write();
  return path;
}

/// Fonts and rasterizers of other machines move edges by a pixel; a missing part or another colour differs more.
void compare(const std::string& name, const std::string& drawn) {
  const std::string baseline = kFolder + name + ".png";
  if (std::getenv("ESPDIFF_WRITE_BASELINES") != nullptr) {
    std::filesystem::copy_file(drawn, baseline, std::filesystem::copy_options::overwrite_existing);
    return;
  }
  const Difference found = difference(Picture(drawn), Picture(baseline));
  INFO(name, ": mean ", found.mean, ", far ", found.far_share);
  const bool is_same = found.mean < 2 && found.far_share < 0.02;
  if (!is_same) {
    const std::string kept = (std::filesystem::temp_directory_path() / ("espdiff-" + name + ".png")).string();
    std::filesystem::copy_file(drawn, kept, std::filesystem::copy_options::overwrite_existing);
    MESSAGE("what was drawn instead is kept as ", kept);
  }
  CHECK(is_same);
}

/// Draws a scene small.
std::string drawn_small(const ScratchFolder& scratch, const std::string& vtp, Scene scene) {
  scene.width = 420;
  scene.height = 400;
  render_surface(vtp, scratch.file("drawn.png"), scene);
  return halved(Picture(scratch.file("drawn.png")), scratch.file("half.png"));
}

}  // namespace

TEST_CASE("pictures equal their accepted baselines") {
  if (!espdiff_test::can_draw()) return;
  const ScratchFolder scratch;
  const std::string vtp = espdiff_test::compare_made_pair(scratch);
  Scene linked, split, drawn_maps, sign;
  linked.layout = Layout::kLinked;
  linked.molecule = MoleculeStyle::kSticks;
  linked.opacity.greatest = 0.6;
  compare("linked", drawn_small(scratch, vtp, linked));
  split.layout = Layout::kSplit;
  split.split = 0.45;
  split.title = "before and after";
  compare("split", drawn_small(scratch, vtp, split));
  drawn_maps.isopotentials = {-5, 5};
  drawn_maps.n_field_lines = 30;
  drawn_maps.n_views = 1;
  drawn_maps.turn_deg = 25;
  compare("maps", drawn_small(scratch, vtp, drawn_maps));
  sign.array = RenderArray::kSign;
  sign.molecule = MoleculeStyle::kLines;
  sign.opacity.greatest = 0.7;
  sign.n_labels = 2;
  compare("sign", drawn_small(scratch, vtp, sign));
}

TEST_CASE("a picture with a missing part or a wrong colour is far from its baseline") {
  if (!espdiff_test::can_draw()) return;
  const ScratchFolder scratch;
  const std::string vtp = espdiff_test::compare_made_pair(scratch);
  Scene split;
  split.layout = Layout::kSplit;
  split.split = 0.45;
  split.title = "before and after";
  const auto off = [&](const Scene& scene) {
    return difference(Picture(drawn_small(scratch, vtp, scene)), Picture(kFolder + "split.png"));
  };
  Scene moved = split, narrow = split;
  moved.split = 0.75;
  narrow.range.limit = 5;
  CHECK(off(moved).mean > 2);
  CHECK(off(narrow).mean > 2);
}
