# common.bash: what the other scripts share; sourced, never run.

repository="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"

# Bonds of ligands are the same whether CCP4's library is installed or not.
export CLIBD_MON=

# Prints a line that stands out from a compiler's or apt's output.
say() { printf '== %s\n' "$*"; }

# Ends the script with one line on stderr.
fail() {
  printf '%s: %s\n' "${0##*/}" "$*" >&2
  exit 1
}

# How many compilers may run at once: one a core, and 1.5 GB of memory for each, which is what Thrust and VTK need.
job_count() {
  local cores by_memory
  cores="$(nproc)"
  by_memory="$(awk '/^MemAvailable:/ { n = int($2 / 1500000); print (n < 1 ? 1 : n) }' /proc/meminfo)"
  echo $((cores < by_memory ? cores : by_memory))
}

# How many tests may run at once: while one waits for a browser, a window or a file, another computes.
test_count() { echo $(($(job_count) + 1)); }

# Whether a GPU answers.
has_gpu() { command -v nvidia-smi >/dev/null && nvidia-smi -L >/dev/null 2>&1; }

# Whether the CUDA back end can be built; CMake looks in the same places.
has_nvcc() { command -v nvcc >/dev/null || [[ -x /usr/local/cuda/bin/nvcc ]]; }

# Every source file of ours under the given folders, with one of the given extensions: our_files "h cpp" src tests
our_files() {
  local extension folder
  local -a names=() folders=()
  for extension in $1; do names+=(-o -name "*.$extension"); done
  shift
  for folder in "$@"; do
    if [[ -d "$repository/$folder" ]]; then folders+=("$repository/$folder"); fi
  done
  find "${folders[@]}" -type f \( "${names[@]:1}" \) | sort
}

# write_small_pair A.pqr B.pqr: eight atoms whose places differ a little, to try an installed program.
write_small_pair() {
  local i
  for i in 1 2 3 4 5 6 7 8; do
    printf 'ATOM %d CA ALA A %d %d.0 0.%d 0.%d 0.5 2.0\n' "$i" "$i" $((3 * i)) $((7 * (i % 3) % 10)) $((4 * (i % 2))) >&3
    printf 'ATOM %d CA ALA A %d %d.0 0.%d 0.%d 0.5 2.0\n' "$i" "$i" $((3 * i)) $((7 * (i % 3) % 10)) $((i % 4)) >&4
  done 3>"$1" 4>"$2"
}
