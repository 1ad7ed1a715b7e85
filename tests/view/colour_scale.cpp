// colour_scale.cpp: ranges, round numbers, opacity, and array names.
#include "scene/colour_scale.h"

#include <doctest/doctest.h>

#include <limits>

#include "base/error.h"
#include "support/test_data.h"

using namespace espdiff;  // NOLINT: a test of one header

namespace {
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
}

TEST_CASE("round_up_nicely gives the next round number") {
  CHECK(round_up_nicely(0.97) == doctest::Approx(1));
  CHECK(round_up_nicely(1.2) == doctest::Approx(1.5));
  CHECK(round_up_nicely(0.3) == doctest::Approx(0.3));
  CHECK(round_up_nicely(31) == doctest::Approx(40));
  CHECK(round_up_nicely(8.2) == doctest::Approx(10));
  CHECK(round_up_nicely(0.00061) == doctest::Approx(0.0008));
  CHECK(round_up_nicely(0) == 1);
}

TEST_CASE("the automatic range excludes the tenth of extreme values, on both sides of zero") {
  std::vector<float> values(90, -1.9F);
  values.insert(values.end(), 9, 400.0F);
  const ColourScale scale(RenderArray::kDifference, values, 0);
  CHECK(scale.high() == doctest::Approx(2));
  CHECK(scale.low() == doctest::Approx(-2));
  CHECK(scale.exceeds_high());
  CHECK_FALSE(scale.exceeds_low());
  CHECK(scale.colour(0) == Rgb{221, 221, 221});
  CHECK(scale.colour(400) == diverging_colour(1, espdiff::kRedBlue));
  CHECK(scale.colour(400).blue > scale.colour(400).red);
  CHECK(scale.colour(kNan) == kNoValueColour);
}

TEST_CASE("a given limit is used unchanged, and a displacement starts at zero") {
  const ColourScale scale(RenderArray::kDisplacement, {0.5F, 7, kNan}, 3.3);
  CHECK(scale.low() == 0);
  CHECK(scale.high() == 3.3);
  CHECK(scale.has_missing());
  CHECK(scale.exceeds_high());
}

TEST_CASE("a surface without any difference is drawn in the neutral colour") {
  const ColourScale scale(RenderArray::kDifference, {0, 0, 0}, 0);
  CHECK(scale.high() == 1);
  CHECK(scale.colour(0) == Rgb{221, 221, 221});
}

TEST_CASE("the sign change has two colours") {
  const ColourScale scale(RenderArray::kSign, {0, 1, 1}, 0);
  CHECK(scale.two_classes());
  CHECK(scale.colour(0) == kSameSignColour);
  CHECK(scale.colour(1) == kSignChangeColour);
}

TEST_CASE("a range or values that cannot be drawn are refused") {
  CHECK_THROWS_AS(ColourScale(RenderArray::kDifference, {1}, -2), InputError);
  CHECK_THROWS_AS(ColourScale(RenderArray::kDifference, {1}, kNan), InputError);
  const std::string message = espdiff_test::message_of([] { ColourScale(RenderArray::kDifference, {kNan, kNan}, 0); });
  CHECK(message.find("no vertex has a value in 'potential_difference'") != std::string::npos);
}

TEST_CASE("opacity falls linearly from 1 between the two displacements") {
  const OpacityScale scale{0.5, 2.5, 0.25};
  CHECK(scale.opacity(0) == 1);
  CHECK(scale.opacity(0.5) == 1);
  CHECK(scale.opacity(1.5) == doctest::Approx(0.625));
  CHECK(scale.opacity(9) == 0.25);
  CHECK(scale.opacity(kNan) == 0.25);
}

TEST_CASE("array names are read, and errors list them") {
  CHECK(parse_render_array("sign") == RenderArray::kSign);
  CHECK(std::string(array_name(RenderArray::kDifference)) == "potential_difference");
  CHECK(legend_title(RenderArray::kSource, "mV") == "potential of the source (mV)");
  CHECK(legend_title(RenderArray::kSource, "") == "potential of the source");
  CHECK(legend_title(RenderArray::kSign, "mV").find("mV") == std::string::npos);
  CHECK(legend_title(RenderArray::kSlip, "mV") == "slip, distance from where the atoms went (\xC3\x85)");
  CHECK(espdiff_test::message_of([] { parse_render_array("charge"); }) ==
        "cannot colour by 'charge'; use difference, source, target, sign, displacement, magnitude, residue, plain, "
        "slip or why");
}

TEST_CASE("a field that is zero on most of the surface gets the range of the rest") {
  std::vector<float> values(80, 0);
  for (int i = 1; i <= 10; ++i)
    values.insert(values.end(), {0.1F * static_cast<float>(i), -0.1F * static_cast<float>(i)});
  CHECK(ColourScale(RenderArray::kDifference, values, 0).high() == doctest::Approx(1).epsilon(1e-6));
  values.resize(160, 1e-5F);  // nearly zero is no value of its own
  CHECK(ColourScale(RenderArray::kDifference, values, 0).high() == doctest::Approx(1).epsilon(1e-6));
  const std::vector<float> half = {0, 0, 0, 1, 2, 3};  // not most: they count
  ScaleRange three_fifths;
  three_fifths.percentile = 60;
  CHECK(ColourScale(RenderArray::kDifference, half, three_fifths).high() == 1);
}

TEST_CASE("ranges by percentile, and with both ends given") {
  std::vector<float> values;
  for (int i = 1; i <= 100; ++i) values.push_back(static_cast<float>(i % 2 == 0 ? i : -i));
  ScaleRange range;
  range.percentile = 50;
  CHECK(ColourScale(RenderArray::kDifference, values, range).high() == doctest::Approx(50));
  range.percentile = 100;
  CHECK(ColourScale(RenderArray::kDifference, values, range).high() == doctest::Approx(100));
  range.percentile = 101;
  CHECK_THROWS_AS(ColourScale(RenderArray::kDifference, values, range), InputError);
  range = {0, 98, true, -8, 2};
  const ColourScale given(RenderArray::kTarget, values, range);
  CHECK(given.low() == -8);
  CHECK(given.high() == 2);
  CHECK(given.exceeds_low());
  CHECK(given.colour(-3) == Rgb{221, 221, 221});
  range = {0, 98, true, 2, 2};
  CHECK_THROWS_AS(ColourScale(RenderArray::kTarget, values, range), InputError);
}

TEST_CASE("a magnitude is sequential and has no sign") {
  const ColourScale scale(RenderArray::kMagnitude, {-3, 2, 1}, 3);
  CHECK(scale.low() == 0);
  CHECK(scale.colour(-2) == scale.colour(2));
  CHECK_FALSE(scale.exceeds_low());
  CHECK(scale.colour(3) == sequential_colour(1, kOrangeHue));
}

TEST_CASE("every array name survives writing and reading") {
  for (const std::string& name : render_array_names()) CHECK(to_string(parse_render_array(name)) == name);
  CHECK(parse_render_array("uncertainty") == RenderArray::kSlip);
  CHECK_FALSE(ColourScale(RenderArray::kPlain, {}, 0).has_bar());
}

TEST_CASE("a transparent surface fades from its own opacity") {
  const OpacityScale scale{0.5, 2.5, 0.2, 0.6};
  CHECK(scale.opacity(0) == doctest::Approx(0.6));
  CHECK(scale.opacity(1.5) == doctest::Approx(0.4));
  CHECK(scale.opacity(9) == doctest::Approx(0.2));
  CHECK(scale.faded(0.4) == 0);
  CHECK(scale.faded(1.5) == doctest::Approx(0.5));
  CHECK(scale.faded(kNan) == 1);
}
