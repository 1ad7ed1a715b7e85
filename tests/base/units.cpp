// units.cpp: potential units: spellings, factors against published constants, refusals.
#include "base/units.h"

#include <doctest/doctest.h>

#include "base/error.h"
#include "support/test_data.h"

using espdiff::conversion_factor;
using espdiff::parse_potential_unit;
using espdiff::PotentialUnit;
using espdiff_test::message_of;

namespace {

constexpr PotentialUnit kUnits[] = {PotentialUnit::kKtPerE,    PotentialUnit::kMillivolt,
                                    PotentialUnit::kVolt,      PotentialUnit::kKcalPerMolE,
                                    PotentialUnit::kKjPerMolE, PotentialUnit::kHartreePerE};

}  // namespace

TEST_SUITE_BEGIN("units");

TEST_CASE("the written form is read back") {
  for (const PotentialUnit unit : kUnits) CHECK(parse_potential_unit(to_string(unit)) == unit);
  CHECK(parse_potential_unit(espdiff::to_string(PotentialUnit::kUnknown)) == PotentialUnit::kUnknown);
}

TEST_CASE("common spellings are read") {
  for (const char* text : {"kT/e", "kt/e", "KT/E", "kT_e", "kT e^-1", "kbT/e"})
    CHECK(parse_potential_unit(text) == PotentialUnit::kKtPerE);
  for (const char* text : {"V", "volt", "Volts"}) CHECK(parse_potential_unit(text) == PotentialUnit::kVolt);
  CHECK(parse_potential_unit("mV") == PotentialUnit::kMillivolt);
  CHECK(parse_potential_unit("kcal/mol/e") == PotentialUnit::kKcalPerMolE);
  CHECK(parse_potential_unit("kJ/mol/e") == PotentialUnit::kKjPerMolE);
  CHECK(parse_potential_unit("a.u.") == PotentialUnit::kHartreePerE);
  CHECK_THROWS_AS(parse_potential_unit("furlong"), espdiff::InputError);
  CHECK(message_of([] { parse_potential_unit(""); }).find("use kT/e, mV, V, kcal/mol/e, kJ/mol/e or hartree/e") !=
        std::string::npos);
}

TEST_CASE("factors are those of CODATA 2018") {
  using U = PotentialUnit;
  CHECK(conversion_factor(U::kKtPerE, U::kMillivolt, 298.15) ==
        doctest::Approx(25.6925791).epsilon(1e-8));  // the thermal voltage
  CHECK(conversion_factor(U::kVolt, U::kMillivolt, 300) == doctest::Approx(1000).epsilon(1e-14));
  CHECK(conversion_factor(U::kHartreePerE, U::kVolt, 300) == doctest::Approx(27.211386245988).epsilon(1e-12));
  CHECK(conversion_factor(U::kVolt, U::kKjPerMolE, 300) ==
        doctest::Approx(96.4853321233).epsilon(1e-11));  // Faraday's constant
  CHECK(conversion_factor(U::kKcalPerMolE, U::kKjPerMolE, 300) == doctest::Approx(4.184).epsilon(1e-14));
  CHECK(conversion_factor(U::kKtPerE, U::kKcalPerMolE, 300) ==
        doctest::Approx(0.5961613).epsilon(1e-6));  // RT at 300 K
}

TEST_CASE("a factor and its inverse cancel, and factors chain") {
  for (const PotentialUnit a : kUnits) {
    CHECK(conversion_factor(a, a, 300) == 1.0);
    for (const PotentialUnit b : kUnits) {
      CHECK(conversion_factor(a, b, 310) * conversion_factor(b, a, 310) == doctest::Approx(1).epsilon(1e-14));
      CHECK(conversion_factor(a, PotentialUnit::kVolt, 310) * conversion_factor(PotentialUnit::kVolt, b, 310) ==
            doctest::Approx(conversion_factor(a, b, 310)).epsilon(1e-14));
    }
  }
}

TEST_CASE("an unknown unit equals itself only; the temperature must be positive") {
  CHECK(conversion_factor(PotentialUnit::kUnknown, PotentialUnit::kUnknown, 300) == 1.0);
  CHECK_THROWS_AS(conversion_factor(PotentialUnit::kUnknown, PotentialUnit::kVolt, 300), espdiff::InputError);
  CHECK_THROWS_AS(conversion_factor(PotentialUnit::kVolt, PotentialUnit::kUnknown, 300), espdiff::InputError);
  for (const double temperature : {0.0, -1.0, 0.0 / 0.0}) {
    CHECK_THROWS_AS(conversion_factor(PotentialUnit::kKtPerE, PotentialUnit::kVolt, temperature), espdiff::InputError);
  }
}

TEST_SUITE_END();
