# repeated.tcl: a hundred comparisons with drawings in one VMD: no growth of memory, no molecules or files left.
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

proc once {} {
    set h [espdiff compare [list mol $::adk frame 0 sel "protein and resid < 40" map none] \
        [list mol $::adk frame 1 sel "protein and resid < 40" map none] -grid-spacing 2.5]
    espdiff draw $h
    espdiff delete $h
}

test "a hundred comparisons leave memory, molecules and files as they were" {
    for {set i 0} {$i < 20} {incr i} { once }
    set before [resident_MB]
    for {set i 0} {$i < 80} {incr i} { once }
    set growth [expr {[resident_MB] - $before}]
    note "    [format %.1f $before] MB after 20, [format %.1f $growth] MB more after 100"
    check "growth in MB" {$growth < 15}
    check_equal molecules [molinfo list] $adk
    check_equal handles [espdiff handles] {}
    check_equal files [our_files] {}
}

finish
