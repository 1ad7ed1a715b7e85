# draw.tcl: what is drawn in VMD's window: coloured, transparent where uncertain, with a legend, and nothing of the user's changed.
source [file join $env(ESPDIFF_TESTS) support.tcl]
package require espdiff

proc state {} {
    set state [list top [molinfo top] method [colorinfo scale method] midpoint [colorinfo scale midpoint] \
        min [colorinfo scale min] colors [color scale colors RWB] background [color Display Background]]
    foreach id {0 1 2 7 15} { lappend state [colorinfo rgb $id] }
    foreach mol [molinfo list] {
        if {[molinfo $mol get filetype] eq "{}" } continue
        lappend state $mol [molinfo $mol get {center_matrix rotate_matrix scale_matrix global_matrix drawn active fixed}]
    }
    return $state
}

# The picture in the window, as counts of red, blue, light, white and dark pixels.
proc count_pixels {name} {
    global scratch
    display update
    set path [file join $scratch $name.tga]
    render snapshot $path
    set channel [open $path rb]
    set bytes [read $channel]
    close $channel
    binary scan [string range $bytes 12 15] ss width height
    set pixels [string range $bytes 18 [expr {17 + 3 * $width * $height}]]
    array set n {red 0 blue 0 light 0 white 0 dark 0 brown 0}
    # Every seventh pixel will do.
    for {set i 0} {$i < $width * $height} {incr i 7} {
        binary scan $pixels @[expr {3 * $i}]cucucu b g r
        if {$r > $b + 60 && $r > $g + 60} { incr n(red) }
        if {$b > $r + 60 && $b > $g + 40} { incr n(blue) }
        if {$r > $b + 60 && $g > $b + 20} { incr n(brown) }
        if {min($r, $g, $b) > 110} { incr n(light) }
        if {min($r, $g, $b) > 250} { incr n(white) }
        if {max($r, $g, $b) < 20} { incr n(dark) }
    }
    return [array get n]
}

foreach {name side} {scTIM_chainA source dTIM_chainA target} {
    set $side [mol new [input pair_tim_maps/$name.pqr] type pqr waitfor all]
    mol addfile [input pair_tim_maps/${name}_pot-PE0.dx] type dx waitfor all [set $side]
}
axes location off
display resize 600 500
rotate y by 30
color scale method BGR
color scale midpoint 0.3
set comparison [espdiff compare [list mol $source map 0] [list mol $target map 0]]
mol off $source
mol off $target

test "the difference is drawn, and the user's settings are as they were" {
    set before [state]
    set drawn [espdiff draw $comparison]
    check_equal state [state] $before
    check "molecules" {[llength $drawn] >= 2}
    set n [count_pixels difference]
    note "    $n"
    check "red" {[dict get $n red] > 200}
    check "blue" {[dict get $n blue] > 200}
    check "light" {[dict get $n light] > 1000}
}

test "it stays as it is when the user changes the colour scale" {
    set before [count_pixels before]
    color scale method RGryB
    color scale midpoint 0.8
    check_equal pixels [count_pixels after] $before
    color scale method BGR
    color scale midpoint 0.3
}

test "another quantity takes its place, with other colours" {
    set older [espdiff draw $comparison]
    set drawn [espdiff draw $comparison -color displacement]
    foreach mol $older { check "older molecule $mol is gone" {$mol ni [molinfo list]} }
    set n [count_pixels displacement]
    check "brown" {[dict get $n brown] > 200}
    check "no blue" {[dict get $n blue] < 20}
    espdiff draw $comparison -color path_length -uncertain plain
    set n [count_pixels path_length]
    check "brown" {[dict get $n brown] > 200}
    check "no blue" {[dict get $n blue] < 20}
    espdiff draw $comparison -color none -legend 0
    set n [count_pixels none]
    check "no colour" {[dict get $n red] + [dict get $n blue] + [dict get $n brown] < 20}
}

test "where it is trusted, and one colour a reason why not elsewhere" {
    set n [count_pixels before_reasons]
    espdiff draw $comparison -color why
    set words [dict values $::espdiff::drawn_texts]
    foreach expected {trusted slipped {on another residue}} {
        check "$expected in the legend" {[string match "*$expected *%*" $words]}
    }
    check "no fading is explained" {![string match "*uncertain*" $words]}
    set n [count_pixels reasons]
    note "    $n"
    check "light where it is trusted" {[dict get $n light] > 1000}
    check "yellow and red where it is not" {[dict get $n brown] > 100}
    set shares 0
    foreach {reason meaning share} [::espdiff::core::reasons $comparison] { set shares [expr {$shares + $share}] }
    check "shares add up to what is matched: $shares" {$shares > 0.98 && $shares < 1.0001}
    check_refused {::espdiff::core::triangles $comparison 0 {reason 99}} {ESPDIFF INPUT} "reason: 99 is none of this surface"
}

test "signed values in other colours, for a reader to whom red and blue mean something else" {
    set before [state]
    espdiff draw $comparison
    set usual [count_pixels usual]
    espdiff draw $comparison -colors purple-orange
    check_equal state [state] $before
    set n [count_pixels purple_orange]
    note "    $n, not $usual"
    check "orange" {[dict get $n brown] > 200 && [dict get $usual brown] < 20}
    check "purple, not blue" {[dict get $n blue] < [dict get $usual blue] / 4}
    # The ends of red-blue exchanged: what was red is blue.
    espdiff draw $comparison -colors cool-warm
    set n [count_pixels cool_warm]
    note "    $n"
    check "red and blue" {[dict get $n red] > 100 && [dict get $n blue] > 100}
    check_refused {espdiff draw $comparison -colors rainbow} {ESPDIFF INPUT} "red-blue"
}

test "VMD's lights do not wash the colours out" {
    espdiff draw $comparison -uncertain plain -legend 0
    rotate y by -30
    set n [count_pixels lights]
    rotate y by 30
    note "    $n"
    check "not white" {[dict get $n white] < 0.005 * [dict get $n light]}
}

test "what is uncertain is opaque and grey, or transparent" {
    espdiff draw $comparison -uncertain plain
    set plain [count_pixels plain]
    espdiff draw $comparison -uncertainty-limit 0.5
    set faded [count_pixels faded]
    check "less colour" {[dict get $faded red] < [dict get $plain red] - 100}
    check "no holes" {abs([dict get $faded dark] - [dict get $plain dark]) < 300}
    foreach material [lsearch -all -inline [material list] Espdiff*] {
        check_equal "opacity of $material" [format %.1f [lindex [material settings $material] 5]] 1.0
    }
    espdiff draw $comparison -uncertainty-limit 0.5 -uncertain transparent
    set half [count_pixels transparent]
    check "darker" {[dict get $half dark] > [dict get $plain dark] + 300}
    check_refused {espdiff draw $comparison -transparency none} {ESPDIFF INPUT} "-uncertain"
}

test "a range saturates, and is refused when it is none" {
    espdiff draw $comparison -range {-0.5 0.5} -uncertain plain
    set narrow [count_pixels narrow]
    espdiff draw $comparison -range {-20 20} -uncertain plain
    set wide [count_pixels wide]
    check "narrow is redder" {[dict get $narrow red] > [dict get $wide red] + 300}
    check_refused {espdiff draw $comparison -range {2 1}} {ESPDIFF INPUT} "-range"
    check_refused {espdiff draw $comparison -color heat} {ESPDIFF INPUT} "difference, sign"
    check_refused {espdiff draw comparison99} {ESPDIFF INPUT} "comparison99"
}

test "the source's side is drawn where the source is" {
    foreach mol [espdiff draw $comparison -surface source -legend 0 -uncertain plain] {}
    check "drawn" {[dict get [count_pixels source] light] > 1000}
}

test "shapes alone have a displacement and no difference" {
    set shapes [espdiff compare [list mol $source map none] [list mol $target map none] -grid-spacing 1.5]
    check_refused {espdiff draw $shapes -color difference} {ESPDIFF INPUT} "no potentials"
    espdiff draw $shapes
    espdiff delete $shapes
}

test "undraw takes everything away, also after the user deleted a part" {
    set drawn [espdiff draw $comparison]
    mol delete [lindex $drawn 0]
    espdiff undraw $comparison
    foreach mol $drawn { check "molecule $mol is gone" {$mol ni [molinfo list]} }
    espdiff undraw
    set n [count_pixels empty]
    check "nothing is left" {[dict get $n light] < 5}
    espdiff draw $comparison
    espdiff delete $comparison
    check_equal "molecules" [molinfo list] [list $source $target]
}

test "redrawing: how long" {
    set comparison [espdiff compare [list mol $source map 0] [list mol $target map 0]]
    espdiff draw $comparison
    set begun [clock milliseconds]
    foreach color {sign difference sign difference} { espdiff draw $comparison -color $color; display update }
    note "    [espdiff result $comparison n_triangles] triangles: [expr {([clock milliseconds] - $begun) / 4}] ms a redraw"
}

# VMD is left while this runs: run_in_vmd sees whether it ends.
espdiff compare [list mol $source] [list mol $target] -grid-spacing 0.4 -method deform -min-displacement 0 -command list
after 300
finish
