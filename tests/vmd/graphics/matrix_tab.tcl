# matrix_tab.tcl: the window's tab for matrices in a real VMD, by its widgets: frames, a run, a click on a cell, a plot, closing.
source [file join $env(ESPDIFF_TESTS) support.tcl]
package require espdiff

set mol [mol new [input traj_adk/adk.psf] type psf waitfor all]
mol addfile [input traj_adk/adk_dims.dcd] type dcd waitfor all $mol
set window [espdiff gui]
proc widget {name} { return $::espdiff::gui::widget($name) }
proc wait_until {condition} {
    set end [expr {[clock seconds] + 300}]
    while {![uplevel #0 [list expr $condition]]} {
        if {[clock seconds] > $end} { error "'$condition' did not come true" }
        after 50 {set ::tick 1}
        vwait ::tick
    }
}
::espdiff::gui::show_tab matrix
update
array set ::espdiff::gui::setting {grid-spacing 2}

test "a wrong selection is refused before it is in the list" {
    set ::espdiff::gui::form(matrix,frames) 0:30:60
    foreach {sel words} {protin "not understood by VMD" "resname XXX" "holds no atoms"} {
        set ::espdiff::gui::form(matrix,sel) $sel
        [widget matrix,add] invoke
        set said [[widget matrix,message] cget -text]
        check "said: $said" {[string match "Atoms: the selection '$sel' of molecule $mol (adk.psf) *$words*" $said]}
        check_equal "nothing is added" [[widget matrix,list] children {}] {}
    }
}

test "frames of the molecule are variants" {
    set ::espdiff::gui::form(matrix,sel) protein
    [widget matrix,add] invoke
    set labels {}
    foreach item [[widget matrix,list] children {}] { lappend labels [lindex [[widget matrix,list] item $item -values] 0] }
    check_equal labels $labels {adk:0 adk:30 adk:60}
    check "compute" {[[widget matrix,compute] instate !disabled]}
}

test "fits a screen of 1280 x 800" {
    check "width" {[winfo reqwidth $window] <= 720}
    check "height" {[winfo reqheight $window] <= 760}
}

test "the run, and what it wrote" {
    set ::espdiff::gui::form(matrix,potential) "PME, explicit water"
    set ::espdiff::gui::form(matrix,output) $scratch/m
    [widget matrix,compute] invoke
    wait_until {$::espdiff::gui::matrix_running eq ""}
    check "done" {[string match "6 pairs in *" [[widget matrix,message] cget -text]]}
    check "files" {[file exists $scratch/m.json] && [file exists $scratch/m.csv]}
}

test "a click on a cell compares its pair and draws it" {
    dict with ::espdiff::gui::heat {
        set x [expr {int($left + 1.5 * $cell)}]
        set y [expr {int($top + 0.5 * $cell)}]
    }
    set before [molinfo num]
    event generate [widget matrix,map] <ButtonPress-1> -x $x -y $y
    update
    wait_until {$::espdiff::gui::running eq ""}
    check_equal "the tab stays" [::espdiff::gui::open_tab] matrix
    set values [dict get $::espdiff::gui::matrix_result metrics mean_abs_difference values]
    check_equal "the cell's number" [espdiff result $::espdiff::gui::shown mean_abs_difference] [lindex $values 0 1]
    check "drawn" {[molinfo num] > $before}
    check_equal "the target's frame" [molinfo $mol get frame] 30
}

test "the row in VMD's plot window" {
    ::espdiff::gui::show_tab matrix
    [widget matrix,plot] invoke
    update
    check "a plot" {[llength [multiplot list]] > 0}
    multiplot reset
}

test "closing the window during a run" {
    array set ::espdiff::gui::setting {grid-spacing 0.5}
    set ::espdiff::gui::form(matrix,output) $scratch/last
    [widget matrix,compute] invoke
    after 300 {set ::tick 1}
    vwait ::tick
    set handle $::espdiff::gui::matrix_running
    check "running" {$handle ne ""}
    destroy $window
    update
    check "gone" {$handle ni [espdiff handles]}
}

espdiff delete all
finish
