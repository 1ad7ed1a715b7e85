// units.h: units of electrostatic potential and their conversion.
#pragma once

#include <string>

namespace espdiff {

enum class PotentialUnit { kUnknown, kKtPerE, kMillivolt, kVolt, kKcalPerMolE, kKjPerMolE, kHartreePerE };

/// Written form: "kT/e", "mV", "V", "kcal/(mol e)", "kJ/(mol e)", "hartree/e", "unknown".
std::string to_string(PotentialUnit unit);

/// Reads the written form and common spellings ("kt/e", "kT_e", "volt", "kcal/mol/e", "a.u."); any case.
/// @throws InputError naming the spellings accepted.
PotentialUnit parse_potential_unit(const std::string& text);

/// Follows the unit of a potential in vacuum.
constexpr const char* kInVacuum = " in vacuum";
/// Whether a potential's unit says that it is one in vacuum.
bool is_in_vacuum(const std::string& potential_unit);
/// "kT/e" of "kT/e in vacuum", and of "kT/e".
std::string without_vacuum(const std::string& potential_unit);

/// Factor f such that value[to] = f * value[from]; kT is at `temperature_K`.
/// Constants: CODATA 2018 (exact e, k_B, N_A; hartree 4.3597447222071e-18 J).
/// @throws InputError if either unit is unknown and they differ, or the temperature is not positive.
double conversion_factor(PotentialUnit from, PotentialUnit to, double temperature_K);

}  // namespace espdiff
