# drawings.tcl: drawings as a VMD user treats them: several at once, hidden, deleted, at another frame, alone, rendered, saved.
source [file join $env(ESPDIFF_TESTS) support.tcl]
source [file join $env(ESPDIFF_TESTS) window_support.tcl]
package require espdiff

proc displayed {molecules} { set n 0; foreach mol $molecules { incr n [molinfo $mol get displayed] }; return $n }
# The note of a drawing's frame, if it is shown.
proc shown_notes {} {
    set notes {}
    foreach mol [molinfo list] {
        if {[string match "*espdiff* note*" [molinfo $mol get name]] && [molinfo $mol get displayed]} { lappend notes $mol }
    }
    return $notes
}
proc our_molecules {} { lsearch -all -inline -not -exact [lmap mol [molinfo list] { expr {
    [string match "*espdiff*" [molinfo $mol get name]] ? $mol : "" }}] "" }

test "a drawing in a VMD without molecules is what is seen" {
    set comparison [espdiff compare [list file [input pair_tim_maps/scTIM_chainA.pqr] map [input pair_tim_maps/scTIM_chainA_pot-PE0.dx]] \
        [list file [input pair_tim_maps/dTIM_chainA.pqr] map [input pair_tim_maps/dTIM_chainA_pot-PE0.dx]] -grid-spacing 2]
    set drawn [espdiff draw $comparison]
    check "the surface is the top molecule: [molinfo [molinfo top] get name]" {[molinfo top] == [lindex $drawn 0]}
    set scale [lindex [molinfo [molinfo top] get scale_matrix] 0 0 0]
    check "the view is of it" {$scale < 0.2}
    espdiff delete all
}

load_tim
set comparison [espdiff compare [list mol $source map 0] [list mol $target map 0] -grid-spacing 2]
set reverse [espdiff compare [list mol $target map 0] [list mol $source map 0] -grid-spacing 2]

# The texts that a molecule of ours was drawn with, as triangles; those of the legends.
proc texts_of {mol} { ::espdiff::value_or $::espdiff::drawn_texts $mol {} }
proc legend_texts {} {
    set texts {}
    foreach mol [our_molecules] {
        if {[string match "*legend*" [molinfo $mol get name]]} { lappend texts {*}[texts_of $mol] }
    }
    return $texts
}

test "a drawing takes the place of the one before, unless that is kept" {
    espdiff draw $comparison
    espdiff draw $reverse
    check_equal drawings [dict keys $::espdiff::drawings] $reverse
    check_equal "one legend" [llength [lsearch -all [legend_texts] "*target - source*"]] 1
    check_equal "without a name" [lsearch [legend_texts] "*->*"] -1
    check_refused {espdiff draw $comparison -color path} {ESPDIFF INPUT} "path_length"
    check_equal "an error leaves it" [dict keys $::espdiff::drawings] $reverse
    espdiff undraw
}

test "legends of two drawings stand above each other, and name them" {
    espdiff draw $comparison
    espdiff draw $reverse -keep 1
    foreach name {"scTIM_chainA -> dTIM_chainA: potential*" "dTIM_chainA -> scTIM_chainA: potential*"} {
        check "a legend of $name" {[lsearch [legend_texts] $name] >= 0}
    }
    set heights {}
    foreach mol [our_molecules] {
        if {[string match "*legend*" [molinfo $mol get name]]} {
            lappend heights [lindex [molinfo $mol get global_matrix] 0 1 3]
        }
    }
    check_equal "two legends" [llength $heights] 2
    check "apart" {abs([lindex $heights 0] - [lindex $heights 1]) > 0.05}
    espdiff undraw $reverse
    check_equal "one is left, without a name" [lsearch [legend_texts] "*->*"] -1
}

test "the legend of coloured atoms stands above or below that of the surface" {
    espdiff draw $comparison
    espdiff atoms $comparison -mol target -show 1
    set heights [lmap mol [dict keys $::espdiff::legends] { lindex [molinfo $mol get global_matrix] 0 1 3 }]
    check_equal legends [llength $heights] 2
    check "apart: $heights" {abs([lindex $heights 0] - [lindex $heights 1]) > 0.1}
    espdiff uncolor $comparison
    espdiff undraw
}

test "the molecules of a drawing can be distinguished, and are hidden and shown together" {
    set drawn [espdiff draw $comparison]
    set names [lmap mol $drawn { lindex [molinfo $mol get name] 0 }]
    check "short: $names" {[regexp {^espdiff \d+: difference$} [lindex $names 0]]}
    check_equal "different names" [llength [lsort -unique $names]] [llength $drawn]
    check "few: $names" {[llength $drawn] <= 4}
    mol off [lindex $drawn 0]
    check_equal hidden [displayed $drawn] 0
    mol on [lindex $drawn end]
    check_equal shown [displayed $drawn] [llength $drawn]
    check_equal "the proteins stay" [displayed [list $source $target]] 2
}

test "deleting one of them deletes the drawing" {
    mol delete [lindex $drawn 0]
    update
    check_equal molecules [molinfo list] [list $source $target]
    set drawn [espdiff draw $comparison]
    espdiff undraw
    check_equal molecules [molinfo list] [list $source $target]
}

test "transparency in a rendermode that cannot is told about" {
    display rendermode Normal
    set ::espdiff::said_rendermode 0
    espdiff draw $comparison -uncertain transparent
    check_equal told $::espdiff::said_rendermode 1
    espdiff draw $comparison
}

test "texts are triangles of their own size, within the window" {
    set legend [lindex [::espdiff::drawing_of $comparison] end]
    check_equal "texts" [lrange [texts_of $legend] 1 end-1] {-2.5 -1.25 0 1.25 2.5}
    set high 0
    set wide 0
    foreach item [graphics $legend list] {
        set words [graphics $legend info $item]
        check "no text of VMD's" {[lindex $words 0] ne "text"}
        if {[lindex $words 0] ne "triangle"} continue
        foreach corner [lrange $words 1 3] {
            set wide [expr {max($wide, abs([lindex $corner 0]))}]
            if {[lindex $corner 1] > -0.78} { lappend title [lindex $corner 1] }
        }
    }
    lassign [display get size] width height
    check "as wide as the window at most" {$wide < double($width) / $height}
    # Capitals are 4 % of half the window's height.
    set title [lsort -real $title]
    check "height of the title" {[lindex $title end] - [lindex $title 0] < 0.06}
}

# VMD learns of its window's new size from the window.
proc resized {width height} {
    display resize $width $height
    for {set i 0} {$i < 25} {incr i} { display update ui; pause 60 }
}
proc widest {mol} {
    set wide 0
    foreach item [graphics $mol list] {
        set words [graphics $mol info $item]
        if {[lindex $words 0] ni {triangle tricolor}} continue
        foreach corner [lrange $words 1 3] { set wide [expr {max($wide, abs([lindex $corner 0]))}] }
    }
    return $wide
}

test "the legend follows the size of VMD's window" {
    set before [::espdiff::drawing_of $comparison]
    resized 250 500
    set legend [lindex [::espdiff::drawing_of $comparison] end]
    check_equal "the surface stays" [lrange [::espdiff::drawing_of $comparison] 0 end-1] [lrange $before 0 end-1]
    lassign [display get size] width height
    set wide [widest $legend]
    check "within the window" {$wide < double($width) / $height}
    resized 600 500
    check "wider again" {[widest [lindex [::espdiff::drawing_of $comparison] end]] > $wide}
    espdiff draw $comparison -view linked
    proc apart {} {
        lassign [dict values [dict get $::espdiff::linked panels]] source target
        expr {[lindex [molinfo [lindex $target 0] get global_matrix] 0 0 3]
            - [lindex [molinfo [lindex $source 0] get global_matrix] 0 0 3]}
    }
    set before [apart]
    resized 900 400
    check_close "panels" [apart] [expr {$before * (900.0 / 400) / (600.0 / 500)}] 0.02
    resized 600 500
    espdiff draw $comparison
}

test "every renderer of this VMD takes a drawing with its legend" {
    foreach renderer [render list] {
        # VMD's Wavefront writer makes its material file's name from this ending.
        set path $scratch/out.[expr {$renderer eq "Wavefront" ? "obj" : $renderer}]
        set failed [catch { render $renderer $path } message]
        note "    $renderer: [expr {$failed ? "failed: $message" : "[file size $path] bytes"}]"
        check $renderer {!$failed && [file size $path] > 10000}
        file delete $path
    }
}

test "a saved state has the command that makes the drawing again, and nothing else of it" {
    material change opacity Espdiff100 0.9
    set before [our_molecules]
    mol top $target
    save_state $scratch/state.vmd
    check_equal "drawn again" [llength [our_molecules]] [llength $before]
    check "its material is as the user made it" {abs([lindex [material settings Espdiff100] 5] - 0.9) < 0.01}
    check "small: [file size $scratch/state.vmd] bytes" {[file size $scratch/state.vmd] < 40000}
    set channel [open $scratch/state.vmd]
    set state [read $channel]
    close $channel
    check "no graphics" {[string first "graphics top" $state] < 0}
    check "no material" {[string first Espdiff100 $state] < 0}
    check "the command" {[string first "espdiff draw" $state] > 0}
    material change opacity Espdiff100 1.0
}

test "the state makes the same drawing in a fresh VMD" {
    set channel [open $scratch/again.tcl w]
    puts $channel "lappend auto_path {[file join $env(VMDPLUGINPATH) tcl]}\nmol new\nplay {$scratch/state.vmd}"
    puts $channel "set channel \[open {$scratch/number} w\]"
    puts $channel {puts $channel [espdiff result [lindex [espdiff handles] 0] rms_difference]}
    puts $channel {foreach mol [molinfo list] { puts $channel [molinfo $mol get name] }}
    puts $channel "close \$channel\nquit"
    close $channel
    set vmd [expr {[info exists env(VMD)] ? $env(VMD) : "vmd"}]
    catch { exec $vmd -dispdev text -e $scratch/again.tcl < /dev/null 2>@1 } log
    check "it ran: [string range $log end-600 end]" {[file exists $scratch/number]}
    set channel [open $scratch/number]
    set lines [split [read $channel] \n]
    close $channel
    check_equal number [lindex $lines 0] [espdiff result $comparison rms_difference]
    check_equal "one legend" [llength [lsearch -all $lines "*legend*"]] 1
}

test "at another frame the picture says which frame the surface is of" {
    espdiff undraw
    set adk [mol new [input traj_adk/adk.psf] type psf waitfor all]
    mol addfile [input traj_adk/adk_dims.dcd] type dcd waitfor all $adk
    animate goto 10
    set frames [espdiff compare [list mol $adk frame 0 sel protein map none] [list mol $adk sel protein map none] \
        -grid-spacing 2]
    espdiff draw $frames
    check_equal "its own frame" [shown_notes] {}
    animate goto 60
    check_equal "another one" [llength [shown_notes]] 1
    set words [texts_of [lindex [shown_notes] 0]]
    check "the words" {[string match "*frame 10*another frame*" $words]}
    animate goto 10
    check_equal "back" [shown_notes] {}
    animate goto 20
    espdiff undraw
    check_equal molecules [our_molecules] {}
}

test "unmatched surface is hatched on either side" {
    mol addfile [input traj_adk/adk_dims.dcd] type dcd first 97 last 97 waitfor all $adk
    set last [expr {[molinfo $adk get numframes] - 1}]
    set open [espdiff compare [list mol $adk frame 0 sel protein map none] [list mol $adk frame $last sel protein map none] \
        -grid-spacing 2]
    check "on the target" {[espdiff result $open certificate no_counterpart_area_fraction target] > 0.01}
    foreach surface {mapped source} {
        espdiff draw $open -surface $surface -uncertainty-limit 15
        # Grey and white by number: no colour of the scale.
        set stripes [dict create 2 0 8 0]
        foreach mol [our_molecules] {
            if {![string match "*: slip*" [molinfo $mol get name]]} continue
            foreach item [graphics $mol list] {
                set color [lindex [graphics $mol info $item] end]
                if {[dict exists $stripes $color]} { dict incr stripes $color }
            }
        }
        note "    $surface: dark and light triangles $stripes"
        check "$surface: stripes" {[dict get $stripes 2] > 50 && [dict get $stripes 8] > 50}
    }
}

test "no callback failed" { check_equal errors $background {} }

espdiff delete all
finish
