# common.bash: what the other scripts share; sourced, never run.

repository="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"

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
