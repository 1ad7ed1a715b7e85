# plot.tcl: VMD's plot windows of a trajectory and of a matrix, and a click on a point.
source [file join $env(ESPDIFF_TESTS) support.tcl]
package require espdiff

set mol [mol new [input traj_adk/adk.psf] type psf waitfor all]
mol addfile [input traj_adk/adk_dims.dcd] type dcd waitfor all $mol
set quick {-grid-spacing 2}
espdiff trajectory -mol $mol -frames 0:30:end -sel protein -map none -csv $scratch/t.csv {*}$quick

# All texts on the canvas of a plot.
proc texts {plot} {
    update
    set found {}
    foreach window [winfo children [$plot getpath]] {
        foreach child [concat $window [winfo children $window]] {
            if {[winfo class $child] ne "Canvas"} continue
            foreach item [$child find all] {
                if {[$child type $item] eq "text"} { lappend found [$child itemcget $item -text] }
            }
        }
    }
    return $found
}

test "a window for each unit, with titles and units" {
    set plots [espdiff plot $scratch/t.csv -metrics {mean_displacement_A rmsd_A corrupt_area_fraction}]
    check_equal windows [llength $plots] 2
    set first [texts [lindex $plots 0]]
    foreach text {Frame "value (A)" "Mean displacement" RMSD} { check "$text" {$text in $first} }
    set second [texts [lindex $plots 1]]
    check "percent" {"Corrupt area (%)" in $second}
    foreach plot $plots { $plot quit }
}

test "one window where values are normalized" {
    set plots [espdiff plot $scratch/t.csv -metrics {mean_displacement_A corrupt_area_fraction} -normalize 1]
    check_equal windows [llength $plots] 1
    set found [texts [lindex $plots 0]]
    check "legend" {[lsearch -glob $found "Mean displacement (0: * A, 1: * A)"] >= 0}
    [lindex $plots 0] quit
}

test "a click on a point goes to its frame, or calls the user" {
    set plots [espdiff plot $scratch/t.csv -metrics rmsd_A -mol $mol]
    set binding ""
    foreach window [winfo children [[lindex $plots 0] getpath]] {
        foreach child [concat $window [winfo children $window]] {
            if {[winfo class $child] ne "Canvas"} continue
            foreach item [$child find withtag point] {
                set script [$child bind $item <Any-ButtonPress>]
                if {[regexp {plot_clicked \d+ \d+ 60(\.0)? } $script]} { set binding $script }
            }
        }
    }
    check "a binding" {$binding ne ""}
    uplevel #0 $binding
    check_equal frame [molinfo $mol get frame] 60
    [lindex $plots 0] quit
}

test "a plot is written to a file although VMD's TMPDIR names no folder" {
    # VMD's own start file sets it so where it is unset and there is no /usr/tmp, as on Debian.
    set before [expr {[info exists env(TMPDIR)] ? $env(TMPDIR) : ""}]
    set env(TMPDIR) /usr/tmp/no/such/folder
    set failed [catch { espdiff plot $scratch/t.csv -metrics rmsd_A -file $scratch/rmsd.svg } message]
    set env(TMPDIR) $before
    check_equal message [expr {$failed ? $message : ""}] ""
    set channel [open $scratch/rmsd.svg]
    set svg [read $channel]
    close $channel
    check "the axis" {[string first RMSD $svg] > 0}
}

test "one variant of a matrix against all others" {
    set matrix [espdiff matrix [list [list mol $mol frames 0:30:90 sel protein map none]] -output $scratch/m {*}$quick]
    set plots [espdiff plot $matrix -source adk.psf:30]
    set found [texts [lindex $plots 0]]
    check "title" {"adk.psf:30 against all others" in $found}
    check "axis" {"Mean displacement (A)" in $found}
    [lindex $plots 0] quit
    check_refused { espdiff plot $matrix -source x } {ESPDIFF INPUT} "unknown variant 'x'"
    check_refused { espdiff plot $matrix -metrics size } {ESPDIFF INPUT} "unknown metric 'size'"
}

finish
