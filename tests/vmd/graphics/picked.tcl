# picked.tcl: a click on a drawn surface, as VMD tells of it: what is named, where, and for how long.
source [file join $env(ESPDIFF_TESTS) support.tcl]
source [file join $env(ESPDIFF_TESTS) window_support.tcl]
package require espdiff

load_tim
foreach mol [list $source $target] { mol off $mol }
set comparison [espdiff compare [list mol $source map 0] [list mol $target map 0] -grid-spacing 2]
espdiff gui
update
set drawn [espdiff draw $comparison]
set surface [lindex $drawn 0]
display update

# Picks the n-th point as VMD does.
proc pick {mol n} {
    set tags {}
    foreach item [graphics $mol list] {
        if {[lindex [graphics $mol info $item] 0] eq "pickpoint"} { lappend tags $item }
    }
    set ::vmd_pick_graphics "$mol [lindex $tags $n] 1 0"
    update
    return [lindex [graphics $mol info [lindex $tags $n]] 1]
}

test "the point that is seen: its residue, and values as the surface has them" {
    set point [pick $surface 1000]
    set eye [::espdiff::eye_of $surface $point]
    set seen [::espdiff::core::seen_point $comparison mapped $eye $point]
    check "in front of the point, or there" {[vecdist $eye [dict get $seen position]] < [vecdist $eye $point] + 1e-3}
    foreach row [espdiff residues $comparison] { if {[dict get $row index] == [dict get $seen residue]} break }
    set near [atomselect $target "resid [dict get $row target_number]"]
    set least 1e9
    foreach atom [$near get {x y z}] { set least [expr {min($least, [vecdist $atom [dict get $seen position]])}] }
    $near delete
    check "its residue is there" {$least < 5}
    # The target's own map at this place, as VMD has it.
    set probe [atomselect $target "index 0"]
    set at [lindex [$probe get {x y z}] 0]
    $probe moveby [vecsub [dict get $seen position] $at]
    check_close "the target's potential" [lindex [$probe get interpvol0] 0] [dict get $seen target] 0.1
    $probe moveby [vecsub $at [dict get $seen position]]
    $probe delete
    set difference [expr {[dict get $seen target] - [dict get $seen source]}]
    foreach words [list [dict get $row name][dict get $row number] "source [format %.3g [dict get $seen source]]" \
        "target [format %.3g [dict get $seen target]]" "difference [format %.3g $difference] kT/e" "slip "] {
        check "in the view: $words" {[string first $words [message_line]] > 0}
    }
}

test "a ball and a text in the view, of the last click only, and gone with the drawing" {
    set before [molinfo num]
    pick $surface 2000
    check_equal "two molecules, as before" [molinfo num] $before
    lassign [lindex $::espdiff::picked 1] ball note
    check "a ball" {[lsearch [lmap item [graphics $ball list] { lindex [graphics $ball info $item] 0 }] sphere] >= 0}
    check "a text" {[string match "*kT/e*" [dict get $::espdiff::drawn_texts $note]]}
    espdiff undraw
    check_equal molecules [molinfo list] [list $source $target]
    check_equal "no trace" [trace info variable ::vmd_pick_graphics] {}
    set drawn [espdiff draw $comparison]
}

test "in linked views the source's panel is the source's surface" {
    espdiff draw $comparison -view linked
    dict for {mol place} $::espdiff::pick_surfaces { lappend surfaces [lindex $place 1] }
    check_equal surfaces [lsort $surfaces] {mapped mapped source}
    dict for {mol place} $::espdiff::pick_surfaces { if {[lindex $place 1] eq "source"} break }
    pick $mol 500
    check "told" {[string match "$comparison, *kT/e*" [message_line]]}
    espdiff undraw
    check_equal molecules [molinfo list] [list $source $target]
}

test "the window's switch is VMD's mouse mode, both ways" {
    [widget draw,pick] invoke
    check_equal mode $::vmd_mouse_mode labelatom
    mouse mode rotate
    update
    check_equal switch $::espdiff::gui::form(draw,pick) 0
}

test "no callback failed" { check_equal errors $background {} }

espdiff delete all
finish
