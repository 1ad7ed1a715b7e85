// units.cpp: units of electrostatic potential and their conversion.
#include "base/units.h"

#include <algorithm>
#include <cctype>
#include <cstring>

#include "base/error.h"
#include "base/formatted.h"

namespace espdiff {
namespace {

constexpr double kElementaryCharge = 1.602176634e-19;  // C
constexpr double kBoltzmann = 1.380649e-23;            // J/K
constexpr double kAvogadro = 6.02214076e23;            // 1/mol
constexpr double kHartree = 4.3597447222071e-18;       // J
constexpr double kCalorie = 4.184;                     // J

double in_volt(PotentialUnit unit, double temperature_K) {
  switch (unit) {
    case PotentialUnit::kKtPerE: return kBoltzmann * temperature_K / kElementaryCharge;
    case PotentialUnit::kMillivolt: return 1e-3;
    case PotentialUnit::kVolt: return 1.0;
    case PotentialUnit::kKcalPerMolE: return 1e3 * kCalorie / kAvogadro / kElementaryCharge;
    case PotentialUnit::kKjPerMolE: return 1e3 / kAvogadro / kElementaryCharge;
    case PotentialUnit::kHartreePerE: return kHartree / kElementaryCharge;
    case PotentialUnit::kUnknown: break;
  }
  throw InputError(
      "a potential of unknown unit cannot be converted; name its unit (kT/e, mV, V, kcal/mol/e, kJ/mol/e, hartree/e)");
}

}  // namespace

std::string to_string(PotentialUnit unit) {
  switch (unit) {
    case PotentialUnit::kKtPerE: return "kT/e";
    case PotentialUnit::kMillivolt: return "mV";
    case PotentialUnit::kVolt: return "V";
    case PotentialUnit::kKcalPerMolE: return "kcal/(mol e)";
    case PotentialUnit::kKjPerMolE: return "kJ/(mol e)";
    case PotentialUnit::kHartreePerE: return "hartree/e";
    case PotentialUnit::kUnknown: break;
  }
  return "unknown";
}

PotentialUnit parse_potential_unit(const std::string& text) {
  std::string key;
  for (const char c : text) {
    if (std::isalpha(static_cast<unsigned char>(c)) != 0)
      key += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  if (key == "kte" || key == "kt" || key == "kbte") return PotentialUnit::kKtPerE;
  if (key == "mv" || key == "millivolt") return PotentialUnit::kMillivolt;
  if (key == "v" || key == "volt" || key == "volts") return PotentialUnit::kVolt;
  if (key == "kcalmole" || key == "kcalmol") return PotentialUnit::kKcalPerMolE;
  if (key == "kjmole" || key == "kjmol") return PotentialUnit::kKjPerMolE;
  if (key == "hartreee" || key == "hartree" || key == "au") return PotentialUnit::kHartreePerE;
  if (key == "unknown") return PotentialUnit::kUnknown;
  throw InputError("unknown potential unit '" + text + "'; use kT/e, mV, V, kcal/mol/e, kJ/mol/e or hartree/e");
}

bool is_in_vacuum(const std::string& potential_unit) {
  const std::string ending = kInVacuum;
  return potential_unit.size() > ending.size() &&
         potential_unit.compare(potential_unit.size() - ending.size(), ending.size(), ending) == 0;
}

std::string without_vacuum(const std::string& potential_unit) {
  return is_in_vacuum(potential_unit) ? potential_unit.substr(0, potential_unit.size() - std::strlen(kInVacuum))
                                      : potential_unit;
}

double conversion_factor(PotentialUnit from, PotentialUnit to, double temperature_K) {
  if (from == to) return 1.0;
  if (!(temperature_K > 0)) {
    throw InputError("temperature " + formatted(temperature_K) + " K is not positive; kT needs one, such as 300");
  }
  return in_volt(from, temperature_K) / in_volt(to, temperature_K);
}

}  // namespace espdiff
