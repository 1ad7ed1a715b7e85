# two_chains.bash: two small chains in a scratch folder, the command that compares them on the GPU, and a count of
# failures. Sourced by the tests that run the whole program.
scratch="$(mktemp -d)"
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"
unset ESPDIFF_CUDA_EMULATOR

row() {
  local i
  for i in 0 1 2 3 4 5; do
    printf 'ATOM  %5d  CA  ALA A%4d    %8.3f%8.3f%8.3f %7.4f %6.4f\n' $((i + 1)) $((i + 1)) \
      "$(awk -v i="$i" -v s="$1" 'BEGIN { print 3 * i + s * i }')" "$(awk -v i="$i" 'BEGIN { print 0.7 * (i % 3) }')" 0.2 0.5 2
  done
}
row 0 >a.pqr
row 0.1 >b.pqr
{ for s in 0 0.05 0.1; do echo MODEL; row "$s"; echo ENDMDL; done; } >frames.pqr
inputs="$(ls)"
compare=(compare a.pqr b.pqr --grid-spacing 2 --potential coulomb --device cuda --threads 1 -q -o out --exit-zero --overwrite)

failures=0
wrong() { echo "FAILED: $*"; failures=$((failures + 1)); }
