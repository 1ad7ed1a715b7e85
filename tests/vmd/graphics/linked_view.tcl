# linked_view.tcl: source, target and difference side by side: where they are, that they turn together, and that nothing stays behind.
source [file join $env(ESPDIFF_TESTS) support.tcl]
package require espdiff

foreach {name side} {scTIM_chainA source dTIM_chainA target} {
    set $side [mol new [input pair_tim_maps/$name.pqr] type pqr waitfor all]
}
axes location off
display resize 900 400
# The source is put elsewhere: what is beside each other on the screen is so by the superposition.
set atoms [atomselect $source all]
$atoms move [transaxis y 70]
$atoms moveby {30 -10 5}
$atoms delete
set other [mol new [input ubq/ubq.pqr] type pqr waitfor all]
mol top $target
rotate x by 25
set comparison [espdiff compare [list mol $source map pme] [list mol $target map pme] -grid-spacing 1.5]

proc state {molecules} {
    set state [list [molinfo top] [display get projection]]
    foreach mol $molecules {
        lappend state $mol [molinfo $mol get {center_matrix rotate_matrix scale_matrix global_matrix displayed active}]
    }
    return $state
}
# Where an atom is on the screen, in VMD's units: global, rotation, scale, centre.
proc on_screen {mol index} {
    set atom [atomselect $mol "index $index"]
    set place [concat [lindex [$atom get {x y z}] 0] 1]
    $atom delete
    foreach matrix {center_matrix scale_matrix rotate_matrix global_matrix} {
        set next {}
        foreach row [lindex [molinfo $mol get $matrix] 0] {
            set sum 0
            foreach a $row b $place { set sum [expr {$sum + $a * $b}] }
            lappend next $sum
        }
        set place $next
    }
    return [lrange $place 0 2]
}
proc shift {mol} { lindex [molinfo $mol get global_matrix] 0 0 3 }
# An atom far from the middle, of both structures.
proc atom_of {mol} {
    set atom [atomselect $mol "name CA and resid 30"]
    set index [lindex [$atom list] 0]
    $atom delete
    return $index
}
proc check_linked {} {
    global source target
    set a [on_screen $source [atom_of $source]]
    set b [on_screen $target [atom_of $target]]
    set width [expr {[shift $target] - [shift $source]}]
    check "panels apart" {$width > 0.5}
    foreach x $a y $b offset [list $width 0 0] {
        check "the same place in both panels" {abs($y - $x - $offset) < 0.05}
    }
}

set before [state [list $source $target $other]]
test "three panels, each with its surface; source and target lie alike" {
    set drawn [espdiff draw $comparison -view linked]
    set names {}
    foreach mol $drawn { lappend names [molinfo $mol get name] }
    foreach what {source target difference title legend} { check $what {[lsearch -glob $names "*$what*"] >= 0} }
    check_linked
    check_equal projection [display get projection] Orthographic
    check_equal "who is displayed" [list [molinfo $source get displayed] [molinfo $target get displayed] \
        [molinfo $other get displayed]] {1 1 0}
}
test "the mouse turns all panels together, and the view can be reset" {
    rotate y by 50
    rotate x by -20
    check_linked
    scale by 1.2
    check_linked
    display resetview
    check_linked
}
test "the picture shows three surfaces, in each third red and blue" {
    display update
    set path [file join $scratch linked.tga]
    render snapshot $path
    set channel [open $path rb]
    set bytes [read $channel]
    close $channel
    binary scan [string range $bytes 12 15] ss width height
    array set count {}
    for {set i 0} {$i < $width * $height} {incr i 5} {
        binary scan $bytes @[expr {18 + 3 * $i}]cucucu b g r
        set third [expr {3 * ($i % $width) / $width}]
        if {$r > $b + 40 && $r > $g + 40} { incr count($third,red) }
        if {$b > $r + 40 && $b > $g + 30} { incr count($third,blue) }
    }
    note "    [array get count]"
    foreach third {0 1 2} { foreach color {red blue} { check "$third $color" {$count($third,$color) > 50} } }
}
test "a highlight is in both molecules" {
    set index [dict get [lindex [espdiff residues $comparison] 29] index]
    check_equal molecules [espdiff highlight $comparison [list $index]] [list $source $target]
    foreach mol [list $source $target] { check_equal reps [molinfo $mol get numreps] 2 }
    espdiff highlight $comparison [list $index] -face 1
    set front [atomselect $target [lindex [molinfo $target get "{selection 1}"] 0]]
    set whole [atomselect $target all]
    set place [vectrans [lindex [molinfo $target get rotate_matrix] 0] \
        [vecsub [measure center $front] [measure center $whole]]]
    check "in front" {[lindex $place 2] > 5 && hypot([lindex $place 0], [lindex $place 1]) < 0.1}
    check_linked
    $front delete
    $whole delete
    espdiff highlight $comparison {}
    foreach mol [list $source $target] { check_equal reps [molinfo $mol get numreps] 1 }
    check_refused {espdiff highlight $comparison 99999} {ESPDIFF INPUT} "'99999' is not the `index`"
}
test "undraw puts everything back; the molecules stay turned" {
    rotate z by 40
    set turned [molinfo $target get rotate_matrix]
    espdiff undraw
    set now [state [list $source $target $other]]
    foreach {mol then} [lrange $before 2 end] {same is} [lrange $now 2 end] {
        foreach what {center rotate scale global displayed active} a $then b $is {
            if {$what eq "rotate"} { set a [lindex $turned 0] }
            check_equal "molecule $mol, $what" $b $a
        }
    }
    check_equal "top and projection" [lrange $now 0 1] [lrange $before 0 1]
    check_equal molecules [molinfo list] [list $source $target $other]
}
test "another drawing ends it; a deleted molecule does no harm" {
    espdiff draw $comparison -view linked -color displacement -legend 0
    espdiff draw $comparison
    check_equal projection [display get projection] Perspective
    check_equal displayed [molinfo $other get displayed] 1
    espdiff draw $comparison -view linked
    mol delete $other
    mol delete [lindex [espdiff draw $comparison -view linked] 0]
    display resetview
    espdiff delete $comparison
    check_equal molecules [molinfo list] [list $source $target]
    check_equal projection [display get projection] Perspective
}
test "shapes alone, and files" {
    set shapes [espdiff compare [list file [input pair_tim_maps/scTIM_chainA.pqr]] \
        [list file [input pair_tim_maps/dTIM_chainA.pqr]] -grid-spacing 2]
    check "drawn" {[llength [espdiff draw $shapes -view linked]] > 3}
    check_refused {espdiff highlight $shapes 1} {ESPDIFF INPUT} "came from files"
    espdiff delete $shapes
    set surface [espdiff surface [list mol $target] -grid-spacing 2]
    check_refused {espdiff draw $surface -view linked} {ESPDIFF INPUT} "is a surface"
}

finish
