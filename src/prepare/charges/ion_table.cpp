// ion_table.cpp: oxidation states and radii of ions by element.
#include "prepare/charges/ion_table.h"

#include <array>
#include <string_view>

#include "align/residue_charges.h"
#include "io/molecules/elements.h"

namespace espdiff {
namespace {

struct IonRow {
  std::string_view element;
  IonParameters ion;
};

/// The most common state of an element comes first.
constexpr std::array<IonRow, 61> kIonRows = {{
    {"LI", {1, 1.025}}, {"NA", {1, 1.369}},  {"K", {1, 1.705}},   {"RB", {1, 1.813}}, {"CS", {1, 1.976}},
    {"F", {-1, 2.303}}, {"CL", {-1, 2.513}}, {"BR", {-1, 2.608}}, {"I", {-1, 2.860}}, {"BE", {2, 0.956}},
    {"MG", {2, 1.360}}, {"CA", {2, 1.649}},  {"SR", {2, 1.810}},  {"BA", {2, 2.019}}, {"RA", {2, 2.019}},
    {"V", {2, 1.364}},  {"MN", {2, 1.407}},  {"FE", {3, 1.386}},  {"FE", {2, 1.353}}, {"CO", {2, 1.299}},
    {"CO", {3, 1.299}}, {"NI", {2, 1.255}},  {"CU", {2, 1.218}},  {"CU", {1, 1.201}}, {"ZN", {2, 1.271}},
    {"PD", {2, 1.303}}, {"PT", {2, 1.266}},  {"AG", {1, 1.341}},  {"AG", {2, 1.336}}, {"CD", {2, 1.412}},
    {"HG", {2, 1.407}}, {"SN", {2, 1.666}},  {"PB", {2, 1.745}},  {"TL", {1, 1.703}}, {"TL", {3, 1.513}},
    {"CR", {3, 1.344}}, {"CR", {2, 1.346}},  {"AL", {3, 1.297}},  {"IN", {3, 1.461}}, {"Y", {3, 1.602}},
    {"LA", {3, 1.718}}, {"CE", {3, 1.741}},  {"PR", {3, 1.733}},  {"ND", {3, 1.681}}, {"SM", {3, 1.659}},
    {"SM", {2, 1.819}}, {"EU", {3, 1.666}},  {"EU", {2, 1.802}},  {"GD", {3, 1.623}}, {"TB", {3, 1.630}},
    {"DY", {3, 1.609}}, {"HO", {3, 1.602}},  {"ER", {3, 1.602}},  {"TM", {3, 1.602}}, {"YB", {3, 1.588}},
    {"YB", {2, 1.642}}, {"LU", {3, 1.588}},  {"ZR", {4, 1.519}},  {"HF", {4, 1.499}}, {"TH", {4, 1.708}},
    {"U", {4, 1.684}},
}};

std::string capitals(std::string text) {
  for (char& c : text) c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  return text;
}

}  // namespace

std::optional<IonParameters> ion_parameters(const std::string& residue_name, const std::string& element) {
  const std::string symbol = capitals(element);
  // Hydroxide, whose hydrogen no crystal shows.
  if (residue_name == "OH" && symbol == "O") return IonParameters{-1, element_radius("O")};
  const IonRow* usual = nullptr;
  const int named = is_ion_name(residue_name) ? charge_of_group(residue_name, 1).value_or(0) : 0;  // 0: no state
  for (const IonRow& row : kIonRows) {
    if (row.element != symbol) continue;
    if (usual == nullptr) usual = &row;
    if (named == 0 || row.ion.charge == named) return row.ion;
  }
  if (usual == nullptr) return std::nullopt;
  // A rare state has the radius of the usual one.
  return IonParameters{named == 0 ? usual->ion.charge : named, usual->ion.radius};
}

}  // namespace espdiff
