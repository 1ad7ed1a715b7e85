# viewer.tcl: from what VMD holds to the viewer: the molecules and maps of a comparison as files, and its window.
source [file join $env(ESPDIFF_TESTS) support.tcl]
package require espdiff

foreach {name side} {scTIM_chainA source dTIM_chainA target} {
    set $side [mol new [input pair_tim_maps/$name.pqr] type pqr waitfor all]
    mol addfile [input pair_tim_maps/${name}_pot-PE0.dx] type dx waitfor all [set $side]
}
# Not the first frame, nor where the file has it.
animate dup $source
animate goto 1
set all [atomselect $source all frame 1]
$all moveby {3 0 0}
$all delete
set h [espdiff compare [list mol $source frame 0 map 0] [list mol $target map 0] -grid-spacing 1.5]

test "molecules and maps from memory, written and compared again by the command line: the same" {
    set files [espdiff export $h [file join $scratch tim] -inputs 1]
    check_equal files [lsort [lmap path $files { file tail $path }]] \
        {tim.json tim.residues.csv tim.source.pqr tim.source_map.vti tim.target.pqr tim.target_map.vti tim.vtp}
    cd $scratch
    exec $env(ESPDIFF) compare tim.source.pqr tim.target.pqr --source-map tim.source_map.vti \
        --target-map tim.target_map.vti --grid-spacing 1.5 -o again -q
    set channel [open again.json]
    regexp {"rms_difference": ([0-9.e-]+)} [read $channel] -> again
    close $channel
    check_close rms_difference $again [espdiff result $h rms_difference] 1e-6
}

# The horizontal place of the coloured pixels' mean, from 0 to 1, their number, and the width that they take; without the
# head with the verdict, and the legend.
proc picture_of {path} {
    exec convert $path -resize 300x -depth 8 $path.ppm
    set channel [open $path.ppm rb]
    set bytes [read $channel]
    close $channel
    regexp {^P6\s+(\d+)\s+(\d+)\s+255\s} $bytes head width height
    binary scan [string range $bytes [string length $head] end] cu* values
    set sum 0.0
    set n 0
    set i 0
    foreach {r g b} $values {
        if {max($r, $g, $b) - min($r, $g, $b) > 60 && $i > 0.06 * $width * $height
            && $i < 0.75 * $width * $height} {
            set sum [expr {$sum + $i % $width}]
            incr n
            lappend columns [expr {$i % $width}]
        }
        incr i
    }
    set columns [lsort -integer $columns]
    return [list [expr {$sum / $n / $width}] $n [expr {double([lindex $columns end] - [lindex $columns 0]) / $width}]]
}

test "a figure for print in VMD's view: the surface is where VMD shows it" {
    espdiff draw $h -range {-2 2}
    check_equal file [espdiff figure $h $scratch/middle.png -width 900] $scratch/middle.png
    lassign [picture_of $scratch/middle.png] middle n
    check "coloured" {$n > 1000}
    foreach mol [molinfo list] { if {![molinfo $mol get fixed]} { molinfo $mol set global_matrix [list \
        [transoffset {0.6 0 0}]] } }
    espdiff figure $h $scratch/right.png -width 900
    lassign [picture_of $scratch/right.png] right n
    note "    from $middle to $right of the width"
    check "it moved to the right" {$right > $middle + 0.1}
    check_refused {espdiff figure $h $scratch/a.gif} {ESPDIFF INPUT} "a.gif" ".png"
    check_refused {espdiff figure $h $scratch/right.png} {ESPDIFF INPUT} "right.png exists; -overwrite 1 replaces it"
    espdiff undraw
}

test "a figure is as large as on the screen, fades to the same grey, and names the molecules" {
    color Display Background white
    axes location off
    display projection Orthographic
    display depthcue off  ;# it pales the rims
    display resetview
    foreach mol [list $source $target] { mol off $mol }
    rotate y by 50
    # All of it coloured, so that both pictures have the same outline.
    foreach {surface view title} {mapped single "" source single Title mapped linked ""} {
        espdiff draw $h -range {-0.001 0.001} -potential-range {-0.001 0.001} -uncertain plain -surface $surface -view $view
        display update
        render snapshot $scratch/screen.tga
        espdiff figure $h $scratch/large.png -width 900 -title $title -overwrite 1
        lassign [picture_of $scratch/screen.tga] middle - screen
        lassign [picture_of $scratch/large.png] place - figure
        note "    $surface, $view: $screen of the screen's width about $middle, $figure of the figure's about $place"
        check "the same size" {abs($screen / $figure - 1) < 0.03}
        # Of the panels of potentials less is coloured in the figure, which has its own range there.
        check "in the same place" {$view eq "linked" || abs($middle - $place) < 0.02}
    }
    check "to grey" {"--fade-to-grey" in [::espdiff::figure_words $h difference \
        [dict merge [::espdiff::drawn_as $h] {uncertain fade}] {width 900 title "" molecule none}]}
    set channel [open $scratch/tim.json]
    set json [read $channel]
    close $channel
    foreach side {source target} name {scTIM dTIM} {
        check "$side in the record" {[string match "*\"role\": \"${side}_file\",\n*\"path\": *${name}_chainA.pqr*" $json]}
    }
    espdiff undraw
}

test "drawn from these files: both maps at every pixel, and the molecule" {
    set said [exec $env(ESPDIFF) render tim.vtp -o tim.png --molecule cartoon --layout linked --width 900 --height 500 2>@1]
    check_equal "no note about maps" [regexp -inline {[^\n]*vertices' values[^\n]*} $said] {}
    check "a picture" {[file size tim.png] > 30000}
    if {[info exists env(ESPDIFF_KEEP)]} { file copy -force tim.png $env(ESPDIFF_KEEP) }
}

test "the button in the window starts the viewer" {
    espdiff gui
    update
    ::espdiff::gui::show_results $h
    set before [glob -nocomplain /tmp/espdiff-[pid]-view-*]
    $::espdiff::gui::widget(result,view) invoke
    update
    check "told" {[string match "The viewer is starting*" [$::espdiff::gui::widget(message) get 1.0 end]]}
    set window ""
    for {set i 0} {$i < 600 && $window eq ""} {incr i} {
        after 100 {set tick 1}
        vwait tick
        catch { set window [exec xdotool search --onlyvisible --name $h] }
    }
    check "a window" {$window ne ""}
    check_equal "no complaint" [regexp {ended} [$::espdiff::gui::widget(message) get 1.0 end]] 0
    if {[info exists env(ESPDIFF_KEEP)]} {
        after 4000 {set tick 1}
        vwait tick
        exec import -window root [file join $env(ESPDIFF_KEEP) viewer.png]
    }
    exec xdotool windowclose $window
}

espdiff delete $h
finish
