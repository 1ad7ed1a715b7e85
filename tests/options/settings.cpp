// settings.cpp: every setting by name: default, accepted values, and refusals.
#include "options/settings.h"

#include <doctest/doctest.h>

#include <set>

#include "options/options.h"
#include "support/test_data.h"

using espdiff::CompareOptions;
using espdiff::find_setting;
using espdiff::make_options;
using espdiff::Setting;
using espdiff::SettingKind;
using espdiff_test::message_of;

TEST_SUITE_BEGIN("settings");

TEST_CASE("each setting accepts its own default and each choice") {
  std::set<std::string> names;
  for (const Setting& setting : espdiff::settings()) {
    INFO(setting.name);
    CHECK(names.insert(setting.name).second);
    CHECK_FALSE(setting.help.empty());
    CompareOptions options;
    const std::string value = setting.get(options);
    setting.set(options, value);
    CHECK(setting.get(options) == value);
    for (const std::string& choice : setting.choices) {
      setting.set(options, choice);
      CHECK(setting.get(options) == choice);
    }
    if (setting.kind == SettingKind::kNumber || setting.kind == SettingKind::kInteger) {
      const bool is_share =
          setting.accepts == "a number from 0 to 1" || setting.accepts == "a number above 0, at most 1";
      const std::string number = is_share ? "0.7" : "7";
      setting.set(options, number);
      CHECK(setting.get(options) == number);
      CHECK(message_of([&] { setting.set(options, "x"); }) == setting.name + ": 'x' is not " + setting.accepts);
    }
  }
  CHECK(names.size() > 20);
}

TEST_CASE("a setting changes its option") {
  const CompareOptions o = make_options({{"method", "deform"},
                                         {"grid-spacing", "0.5"},
                                         {"regularize-mu", "0.4"},
                                         {"mu", "0.6"},
                                         {"deform-field", "density"},
                                         {"project", "0"},
                                         {"interpolation", "tricubic"},
                                         {"max-iterations", "12"}});
  CHECK(o.surface.grid_spacing_A == 0.5);
  CHECK(o.regularize.mu == 0.4);
  CHECK(o.deform.mu == 0.6);
  CHECK(o.field == espdiff::DeformField::kDensity);
  CHECK_FALSE(o.surface.project);
  CHECK(o.regularize.interpolation == espdiff::Interpolation::kTricubic);
  CHECK(o.deform.max_iterations == 12);
}

TEST_CASE("thesis sets the defaults of the others, in any order") {
  const CompareOptions thesis = espdiff::thesis_options();
  for (const auto& given : {std::vector<std::pair<std::string, std::string>>{{"thesis", "1"}, {"tangential-gain", "3"}},
                            {{"tangential-gain", "3"}, {"thesis", "1"}}}) {
    const CompareOptions o = make_options(given);
    CHECK(o.deform.tangential_gain == 3);
    CHECK(o.regularize.tangential_gain == thesis.regularize.tangential_gain);
    CHECK(o.surface.cavities == thesis.surface.cavities);
  }
  CHECK(make_options({{"thesis", "0"}}).surface.project);
}

TEST_CASE("a refused value is named with the accepted ones") {
  const auto message = [](const std::string& name, const std::string& value) {
    return message_of([&] { make_options({{name, value}}); });
  };
  CHECK(message("grid-spacing", "0") == "grid-spacing: '0' is not a number from 0.001 to 20");
  CHECK(message("grid-spacing", "1 A") == "grid-spacing: '1 A' is not a number from 0.001 to 20");
  CHECK(message("isovalue", "nan") == "isovalue: 'nan' is not a number from 1e-06 to 1e+06");
  CHECK(message("distance-threshold", "-1") == "distance-threshold: '-1' is not a number from 0 to 1000");
  CHECK(message("max-iterations", "2.5") == "max-iterations: '2.5' is not a whole number from 0 to 1000000");
  CHECK(message("cavities", "yes") == "cavities: 'yes' is not 0 or 1");
  CHECK(message("align", "heavy") == "align: 'heavy' is not all, backbone, ca or none");
  CHECK(message("deform-field", "gvf3") == "deform-field: 'gvf3' is not density, distance, gvf or gvf2");
  CHECK(message("gvf-weight", "0") == "gvf-weight: '0' is not a number from 1e-06 to 1e+06");
  CHECK(message("gvf-tolerance", "-1") == "gvf-tolerance: '-1' is not a number from 1e-12 to 1000");
  CHECK(message("gvf-max-sweeps", "many") == "gvf-max-sweeps: 'many' is not a whole number from 1 to 1000000");
  CHECK(message("subdivide", "yes") == "subdivide: 'yes' is not 0 or 1");
  CHECK(message("method", "morf") == "method: 'morf' is not morph or deform");
  CHECK(message("max-stretch", "1") == "max-stretch: '1' is not a number above 1");
  for (const char* share : {"mu", "rho", "regularize-mu", "regularize-rho"}) {
    CHECK(message(share, "1.5") == std::string(share) + ": '1.5' is not a number from 0 to 1");
    CHECK(message(share, "-0.1") == std::string(share) + ": '-0.1' is not a number from 0 to 1");
  }
  CHECK(message("max-edge", "0.01") == "max-edge: '0.01' is not a number from 0.25 to 1000");
  CHECK(message("max-edge", "1e-9") == "max-edge: '1e-9' is not a number from 0.25 to 1000");
  CHECK(message("grid-spacing", "1e-300") == "grid-spacing: '1e-300' is not a number from 0.001 to 20");
  CHECK(message("max-step", "1e-5") == "max-step: '1e-5' is not a number from 0.001 to 1000");
  CHECK(message("gvf-max-sweeps", "2000000000") ==
        "gvf-max-sweeps: '2000000000' is not a whole number from 1 to 1000000");
  CHECK(message("sigmas", "1") == "there is no setting 'sigmas'");
}

TEST_CASE("a setting that the method does not read is refused") {
  CHECK(message_of([] {
          make_options({{"mu", "0.5"}});
        }) ==
        "mu is a setting of the method deform, and the method is morph; give method deform as well, or leave mu out");
  CHECK(message_of([] {
          make_options({{"max-step", "0.5"}, {"method", "deform"}});
        }) ==
        "max-step is a setting of the method morph, and the method is deform; give method morph as well, or leave "
        "max-step out");
  CHECK(make_options({{"thesis", "1"}, {"mu", "0.5"}}).method == espdiff::Method::kDeform);
}

TEST_SUITE_END();
