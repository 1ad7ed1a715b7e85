# repeated.tcl: a hundred comparisons, and drawings, in one VMD: no growth of memory; no molecules, descriptors, threads
# or files left. ESPDIFF_COMPARISONS=1000 makes more of them (scripts/soak).
source [file join $env(ESPDIFF_TESTS) support.tcl]
package require espdiff

proc resident_MB {} {
    set channel [open /proc/self/status]
    set text [read $channel]
    close $channel
    regexp {VmRSS:\s+(\d+)} $text -> kB
    return [expr {$kB / 1024.0}]
}
proc our_files {} { glob -nocomplain -directory /tmp espdiff-[pid]-* }

set adk [mol new [input traj_adk/adk.psf] type psf waitfor all]
mol addfile [input traj_adk/adk_dims.dcd] type dcd first 0 last 1 waitfor all $adk

proc compared {} {
    espdiff compare [list mol $::adk frame 0 sel "protein and resid < 40" map none] \
        [list mol $::adk frame 1 sel "protein and resid < 40" map none] -grid-spacing 2.5
}
proc n_entries {folder} { llength [glob -nocomplain -directory $folder *] }

set n [expr {[info exists env(ESPDIFF_COMPARISONS)] ? max(60, $env(ESPDIFF_COMPARISONS)) : 100}]
set warm_up [expr {max(20, $n / 10)}]

test "many comparisons leave memory, descriptors and threads as they were" {
    for {set i 0} {$i < $warm_up} {incr i} { espdiff delete [compared] }
    set before [resident_MB]
    set allocated [::espdiff::core::allocated_bytes]
    set descriptors [n_entries /proc/self/fd]
    set threads [n_entries /proc/self/task]
    for {} {$i < $n} {incr i} { espdiff delete [compared] }
    set growth [expr {[resident_MB] / $before - 1}]
    set lost [expr {[::espdiff::core::allocated_bytes] - $allocated}]
    note "    $n comparisons: [format %.1f $before] MB after $warm_up, then [format %.2f [expr {100 * $growth}]] % more;\
        $lost bytes more allocated"
    # What was allocated is counted to the byte, VMD's own too; resident memory moves by what the allocator keeps.
    check "what was allocated is given back" {$lost < 200000}
    check "growth of resident memory" {$growth < ($n < 1000 ? 0.05 : 0.01)}
    check_equal descriptors [n_entries /proc/self/fd] $descriptors
    check_equal threads [n_entries /proc/self/task] $threads
    check_equal handles [espdiff handles] {}
    check_equal files [our_files] {}
}

# VMD itself keeps 0.6 kB of each molecule that is made and deleted, and a drawing is several.
test "many drawings leave no molecules, and no more memory than VMD keeps of them" {
    set h [compared]
    for {set i 0} {$i < $warm_up} {incr i} { espdiff draw $h; espdiff undraw $h; update }
    set before [resident_MB]
    for {set i 0} {$i < $n / 2} {incr i} { espdiff draw $h; espdiff undraw $h; update }
    set growth [expr {[resident_MB] - $before}]
    note "    [expr {$n / 2}] drawings: [format %.1f [expr {1024 * $growth / ($n / 2)}]] kB each"
    # Memory comes and goes in steps of some MB.
    check "growth in MB" {$growth < 6 + 0.02 * $n / 2}
    check_equal molecules [molinfo list] $adk
    espdiff delete $h
    check_equal handles [espdiff handles] {}
    check_equal files [our_files] {}
}

finish
