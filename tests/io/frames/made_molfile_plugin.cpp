// made_molfile_plugin.cpp: a molfile plugin as VMD's are, for the tests: texts named *.psf and *.dcd.
// *.psf: "N" and then a line "name residue number segment charge" for each atom. *.dcd: "N edge" and then x y z of each
// atom of each frame.
#include <cstdio>
#include <cstring>
#include <fstream>
#include <string>

#include "io/frames/molfile_abi.h"

namespace {

using namespace espdiff::molfile;

struct Open {
  std::ifstream file;
  int n_atoms = 0;
  float edge = 0;
};

void* open_text(const char* path, const char* type, int* n_atoms) {
  std::printf("a plugin talks on standard output\n");
  std::fprintf(stderr, "and on standard error\n");
  auto* const open = new Open{std::ifstream(path), 0, 0};
  open->file >> open->n_atoms;
  if (std::strcmp(type, "dcd") == 0) open->file >> open->edge;
  *n_atoms = open->n_atoms;
  if (open->file) return open;
  delete open;
  return nullptr;
}

void close_text(void* handle) { delete static_cast<Open*>(handle); }

int read_atoms(void* handle, int* flags, AtomRecord* atoms) {
  auto* const open = static_cast<Open*>(handle);
  for (int i = 0; i < open->n_atoms; ++i) {
    atoms[i] = {};
    std::string name, residue, segment;
    open->file >> name >> residue >> atoms[i].resid >> segment >> atoms[i].charge;
    if (!open->file) return kError;
    name.copy(atoms[i].name, sizeof atoms[i].name - 1);
    residue.copy(atoms[i].resname, sizeof atoms[i].resname);  // fills the field where the name is long
    segment.copy(atoms[i].segid, sizeof atoms[i].segid);
  }
  *flags = kHasCharge;
  return kSuccess;
}

int read_frame(void* handle, int n_atoms, Timestep* frame) {
  auto* const open = static_cast<Open*>(handle);
  std::string number;
  for (int i = 0; i < 3 * n_atoms; ++i) {
    if (!(open->file >> number)) return kEndOfFile;
    if (frame != nullptr) frame->coords[i] = std::stof(number);
  }
  if (frame != nullptr) frame->a = frame->b = frame->c = open->edge;
  return kSuccess;
}

Plugin<18> made(const char* name) {
  Plugin<18> plugin;
  plugin.head.abiversion = 18;
  plugin.head.name = name;
  plugin.file.filename_extension = name;
  plugin.file.open_file_read = open_text;
  plugin.file.close_file_read = close_text;
  return plugin;
}

}  // namespace

#define ENTRY extern "C" __attribute__((visibility("default")))

ENTRY int vmdplugin_init();
ENTRY int vmdplugin_register(void* registrar, RegisterCallback callback);

int vmdplugin_init() { return kSuccess; }

int vmdplugin_register(void* registrar, RegisterCallback callback) {
  static Plugin<18> psf = made("psf"), dcd = made("dcd"), of_the_future = made("xtc");
  psf.file.read_structure = read_atoms;
  dcd.file.read_next_timestep = of_the_future.file.read_next_timestep = read_frame;
  of_the_future.head.abiversion = 99;
  for (Plugin<18>* const plugin : {&psf, &dcd, &of_the_future}) callback(registrar, &plugin->head);
  return kSuccess;
}
