# periodic.tcl: molecules in a periodic cell: cut by its border, and with maps that repeat.
source [file join $env(ESPDIFF_TESTS) support.tcl]
package require espdiff

set adk [mol new [input traj_adk/adk.psf] type psf waitfor all]
mol addfile [input traj_adk/adk_dims.dcd] type dcd first 0 last 4 waitfor all $adk
set edge 90.0
for {set frame 0} {$frame < 5} {incr frame} {
    molinfo $adk set frame $frame
    molinfo $adk set {a b c alpha beta gamma} [list $edge $edge $edge 90 90 90]
}
proc shift {text frame vector} {
    set some [atomselect $::adk $text frame $frame]
    $some moveby $vector
    $some delete
}
proc shapes {args} { return [concat [list mol $::adk sel protein map none] $args] }
set quick {-grid-spacing 2}
set whole [espdiff compare [shapes frame 0] [shapes frame 4] {*}$quick]

test "a molecule that its cell cuts is told so, with the number of its atoms and the remedy" {
    shift "protein and resid > 150" 4 [list $edge 0 0]
    set some [atomselect $adk "protein and resid > 150"]
    set n [$some num]
    $some delete
    check_refused { espdiff compare [shapes frame 0] [shapes frame 4] {*}$quick } {ESPDIFF INPUT} \
        "cut by its periodic cell" "$n of" "whole 1"
}

test "`whole 1` puts it together, and the result is that of the whole one" {
    set mended [espdiff compare [shapes frame 0] [shapes frame 4 whole 1] {*}$quick]
    check_close moved [espdiff result $mended mean_displacement_A] [espdiff result $whole mean_displacement_A] 1e-3
    check "its input says so" {[string match "*whole 1*" [espdiff result $mended inputs]]}
    check_refused { espdiff compare [shapes frame 0] [shapes frame 4 whole yes] } {ESPDIFF INPUT} "not 0 or 1"
}

test "the same along a trajectory" {
    check_refused { espdiff trajectory -mol $adk -sel protein -frames 3:1:4 -map none -csv $scratch/cut.csv {*}$quick } \
        {ESPDIFF INPUT} "cut by its periodic cell" "-whole 1"
    set run [espdiff trajectory -mol $adk -sel protein -frames 4 -map none -csv $scratch/whole.csv -whole 1 {*}$quick]
    check_equal rows [dict get $run rows] 1
    shift "protein and resid > 150" 4 [list [expr {-$edge}] 0 0]
}

test "a map of the whole cell repeats: no vertex of a protein across its border lies outside" {
    molinfo $adk set frame 0
    set made [espdiff potential -mol $adk -sel protein -frames 0 -method pme -grid 2.0]
    set k [lindex [dict get $made volumes] 0]
    shift all 0 [list [expr {$edge / 2}] 0 0]
    shift all 4 [list [expr {$edge / 2}] 0 0]
    set across [espdiff compare [list mol $adk frame 0 sel protein map $k] [list mol $adk frame 4 sel protein map $k] {*}$quick]
    check_equal "none outside" [espdiff result $across certificate outside_maps_area_fraction] 0.0
    # With another cell it is a map like any other.
    foreach frame {0 4} { molinfo $adk set frame $frame; molinfo $adk set {a b c} {97 97 97} }
    set beside [espdiff compare [list mol $adk frame 0 sel protein map $k] [list mol $adk frame 4 sel protein map $k] {*}$quick]
    check "outside" {[espdiff result $beside certificate outside_maps_area_fraction] > 0.05}
    check "not trusted there" {[string match "*potential*" [espdiff result $beside certificate untrusted_parts]]}
}

finish
