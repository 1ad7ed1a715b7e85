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
