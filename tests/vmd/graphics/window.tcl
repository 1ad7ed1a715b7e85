# window.tcl: a user's way through the window in a real VMD, by its widgets: pair, drawings, residues, trajectory, matrix, ends.
source [file join $env(ESPDIFF_TESTS) support.tcl]
source [file join $env(ESPDIFF_TESTS) window_support.tcl]
package require espdiff

load_tim
set window [espdiff gui]
array set ::espdiff::gui::setting {grid-spacing 2}
update

test "fits a screen of 1280 x 800 in each tab" {
    foreach name {pair residues trajectory matrix} {
        tab $name
        check "$name: width" {[winfo reqwidth $window] <= 720}
        check "$name: height" {[winfo reqheight $window] <= 760}
    }
}

test "TIM: molecules and maps are chosen already; compared" {
    tab pair
    check "source" {[string match "$source: *" $::espdiff::gui::form(source,mol)]}
    check "target's map" {[string match "0: dTIM*" $::espdiff::gui::form(target,map)]}
    press compare
    wait_until {$::espdiff::gui::running eq ""}
    set comparison $::espdiff::gui::shown
    check_equal trustworthy [[widget verdict_title] cget -text] \
        [expr {[espdiff result $comparison certificate trustworthy] ? "Trustworthy" : "Not trustworthy"}]
    check "a difference" {[espdiff result $comparison mean_abs_difference] > 0.5}
}

test "a page for a browser" {
    check "can be pressed" {![[widget result,report] instate disabled]}
    ::espdiff::gui::report_to $scratch/page.html
    check "written" {[file size $scratch/page.html] > 200000}
    check "told" {[string match "Written: $scratch/page.html; any browser opens it." [message_line]]}
}

test "drawn, side by side, and undrawn" {
    set before [molinfo num]
    press draw
    check "drawn" {[molinfo num] > $before}
    form draw,view linked
    press draw
    check_equal projection [display get projection] Orthographic
    ::espdiff::gui::save_picture_as $scratch/linked.tga
    check "a picture" {[file size $scratch/linked.tga] > 10000}
    press undraw
    check_equal projection [display get projection] Perspective
    check_equal molecules [molinfo num] $before
    form draw,view single
}

test "a residue is highlighted in VMD, and not any more" {
    tab residues
    set table [widget residues,table]
    check_equal "sorted by" $::espdiff::gui::form(residues,sort) share
    ::espdiff::gui::sort_by mean_abs_difference
    set first [lindex [$table children {}] 0]
    set values {}
    foreach item [$table children {}] { lappend values [$table set $item mean_abs_difference] }
    set numbers [lsearch -all -inline -not -exact $values \u2013]
    check "sorted" {$numbers eq [lsort -real -decreasing $numbers]}
    $table selection set $first
    update
    check_equal source [molinfo $source get numreps] 2
    regexp {(\d+)} [$table set $first residue] -> number
    set chosen [atomselect $source [lindex [molinfo $source get "{selection 1}"] 0]]
    check_equal residue [lsort -unique [$chosen get resid]] $number
    $chosen delete
    focus -force $table
    $table focus $first  ;# as a click does
    update
    event generate $table <Down>
    update
    check_equal "another one" [molinfo $source get numreps] 2
    check "moved on" {[$table selection] ne $first}
    press residues,clear
    check_equal "cleared" [list [molinfo $source get numreps] [molinfo $target get numreps]] {1 1}
    $table selection set $first
    update
}

test "its numbers on the atoms" {
    press residues,atoms
    set all [atomselect $source all]
    set most [lindex [lsort -real [$all get user]] end]
    $all delete
    check_close "the greatest" $most [lindex $numbers 0] 0.01
}

test "AdK's trajectory: rows come, and the plot with them" {
    set adk [mol new [input traj_adk/adk.psf] type psf waitfor all]
    mol addfile [input traj_adk/adk_dims.dcd] type dcd waitfor all $adk
    update
    pause 100
    tab trajectory
    check "the trajectory is chosen" {[string match "$adk: adk*" $::espdiff::gui::form(trajectory,mol)]}
    press trajectory,residues
    form trajectory,sel protein trajectory,frames 0:30:end trajectory,map "PME, explicit water" \
        trajectory,csv $scratch/adk.csv
    press trajectory,run
    wait_until {[llength $::espdiff::gui::trajectory_rows] == 2}
    check_equal "points while it runs" [llength [[widget trajectory,plot] find withtag good||bad]] 2
    wait_until {$::espdiff::gui::trajectory_running eq ""}
    check "message" {[string match "4 rows in * s; * trustworthy*" [[widget trajectory,message] cget -text]]}
    set warned [lsearch -all -not -exact [lmap row $::espdiff::gui::trajectory_rows { dict get $row warnings }] ""]
    check "warnings of rows are said" {$warned ne "" && [string match "*. [llength $warned] with a warning: *" \
        [[widget trajectory,message] cget -text]]}
    check_equal "and what to do, in the window's words" [::espdiff::gui::option_label potential pb 0] \
        "Potential Poisson-Boltzmann"
    set texts {}
    foreach item [[widget trajectory,plot] find all] {
        if {[[widget trajectory,plot] type $item] eq "text"} { lappend texts [[widget trajectory,plot] itemcget $item -text] }
    }
    check "title and unit" {"Mean absolute difference (kT/e in vacuum)" in $texts}
}

test "an average over frames is of PME, and a number" {
    form trajectory,average 5
    check_equal words [::espdiff::gui::trajectory_map] {pme average 5}
    form trajectory,map Poisson-Boltzmann
    press trajectory,run
    check "refused: [[widget trajectory,message] cget -text]" \
        {[string match "Average over 5 frames: only PME*" [[widget trajectory,message] cget -text]]}
    form trajectory,average some
    press trajectory,run
    check "refused" {[string match "Average over: 'some'*" [[widget trajectory,message] cget -text]]}
    form trajectory,average 1 trajectory,map "PME, explicit water"
}

test "a click on a point goes to its frame; keys too; VMD's frame is marked" {
    lassign [lindex [dict get $::espdiff::gui::plot_frame points] 2] row x y
    event generate [widget trajectory,plot] <ButtonPress-1> -x [expr {int($x)}] -y [expr {int($y)}]
    check_equal frame [molinfo $adk get frame] 60
    focus -force [widget trajectory,plot]
    update
    event generate [widget trajectory,plot] <Left>
    check_equal frame [molinfo $adk get frame] 30
    set at [lindex [[widget trajectory,plot] coords now] 0]
    animate goto 90
    update
    check "the mark follows" {[lindex [[widget trajectory,plot] coords now] 0] > $at + 50}
}

test "a click on the map of residues goes to the frame, and highlights the residue there" {
    # High enough for more than a pixel for each of 214 residues.
    set size [wm geometry $window]
    wm geometry $window 690x1000
    update
    set lines $::espdiff::gui::form(trajectory,metric)
    form trajectory,metric [lindex [[widget trajectory,metric] cget -values] end]
    event generate [widget trajectory,metric] <<ComboboxSelected>>
    update
    set reps [molinfo $adk get numreps]
    set residues [dict get $::espdiff::gui::residue_table residues]
    set place [lsearch -glob $residues "*LYS 50"]
    event generate [widget trajectory,plot] <ButtonPress-1> -x [expr {int([::espdiff::gui::frame_x 3])}] \
        -y [expr {round([::espdiff::gui::residue_y $place])}]
    update
    check_equal frame [molinfo $adk get frame] 90
    check_equal "a representation more" [molinfo $adk get numreps] [expr {$reps + 1}]
    set chosen [atomselect $adk [lindex [molinfo $adk get "{selection $reps}"] 0]]
    check_equal "of that residue" [lsort -unique [$chosen get {resname resid}]] {{LYS 50}}
    $chosen delete
    check "told" {[string match "Frame 90, *LYS 50: * kT/e in vacuum" [[widget trajectory,point] cget -text]]}
    form trajectory,metric $lines
    event generate [widget trajectory,metric] <<ComboboxSelected>>
    update
    ::espdiff::gui::move_point -2
    press trajectory,residues
    wm geometry $window $size
}

test "that frame compared and drawn" {
    set before [molinfo num]
    press trajectory,compare
    wait_until {$::espdiff::gui::running eq ""}
    check_equal "the tab stays" [::espdiff::gui::open_tab] trajectory
    check_equal "the row's number" [espdiff result $::espdiff::gui::shown mean_abs_difference] \
        [dict get [lindex $::espdiff::gui::trajectory_rows 1] mean_abs_difference]
    check_equal "the target's frame" [molinfo $adk get frame] 30
    check "drawn" {[molinfo num] > $before}
    check_equal "the first one's highlight is gone" [molinfo $source get numreps] 1
}

test "the plot as a picture, beside a trajectory in memory" {
    tab trajectory
    ::espdiff::gui::save_plot_as $scratch/adk.svg
    set channel [open $scratch/adk.svg]
    set svg [read $channel]
    close $channel
    foreach text {"Mean absolute difference" kT/e Frame} { check $text {[string first $text $svg] > 0} }
}

test "a running mean over the points, and the plot as it is seen" {
    check_equal means [::espdiff::gui::running_mean {1 2 "" 6 9} 3] {1.5 1.5 4.0 7.5 7.5}
    form trajectory,smooth 3
    ::espdiff::gui::draw_trajectory
    check_equal line [llength [[widget trajectory,plot] find withtag mean]] 1
    ::espdiff::gui::save_plot_as $scratch/adk.ps
    check "a file" {[file size $scratch/adk.ps] > 3000}
    form trajectory,smooth none
    ::espdiff::gui::guard_in trajectory ::espdiff::gui::draw_trajectory
    check "told" {[string match "Mean over: 'none'*" [[widget trajectory,message] cget -text]]}
    form trajectory,smooth 1
    ::espdiff::gui::draw_trajectory
}

test "a run that is cancelled keeps its rows, and is gone on with" {
    form trajectory,csv $scratch/again.csv trajectory,frames 0:10:end
    press trajectory,run
    wait_until {[llength $::espdiff::gui::trajectory_rows] == 1}
    event generate $window <Escape>
    wait_until {$::espdiff::gui::trajectory_running eq ""}
    check "stopped" {[string match "Stopped: the file has 1 rows*" [[widget trajectory,message] cget -text]]}
    form trajectory,resume 1 trajectory,frames 0:10:end
    press trajectory,run
    wait_until {[llength $::espdiff::gui::trajectory_rows] == 2}
    press trajectory,cancel
    wait_until {$::espdiff::gui::trajectory_running eq ""}
    form trajectory,resume 0
    check_equal frames [dict get [lindex $::espdiff::gui::trajectory_rows 1] frame] 10
}

test "a small matrix, and a cell of it" {
    tab matrix
    form matrix,mol $::espdiff::gui::form(trajectory,mol) matrix,frames 0:45:90 matrix,sel protein \
        matrix,output $scratch/m matrix,potential "PME, explicit water"
    press matrix,add
    press matrix,compute
    wait_until {$::espdiff::gui::matrix_running eq ""}
    check "done" {[string match "6 pairs in *" [[widget matrix,message] cget -text]]}
    dict with ::espdiff::gui::heat { set at [list [expr {int($left + 2.5 * $cell)}] [expr {int($top + 0.5 * $cell)}]] }
    event generate [widget matrix,map] <ButtonPress-1> -x [lindex $at 0] -y [lindex $at 1]
    wait_until {$::espdiff::gui::running eq ""}
    check_equal "the cell's number" [espdiff result $::espdiff::gui::shown mean_abs_difference] \
        [lindex [dict get $::espdiff::gui::matrix_result metrics mean_abs_difference values] 0 2]
}

test "a comparison that is cancelled is gone" {
    array set ::espdiff::gui::setting {grid-spacing 0.4}
    tab pair
    set handles [espdiff handles]
    press compare
    pause 300
    event generate $window <Escape>
    wait_until {$::espdiff::gui::running eq ""}
    check_equal message [message_line] Cancelled.
    check_equal handles [espdiff handles] $handles
}

test "the script has all of it" {
    set script [::espdiff::gui::session_text]
    check "complete" {[info complete $script]}
    foreach words {"espdiff compare" "espdiff trajectory" "espdiff matrix" "mol addfile"} {
        check $words {[string first $words $script] > 0}
    }
}

test "closing the window during a run: nothing stays but results and settings" {
    tab residues
    [widget residues,table] selection set [lindex [[widget residues,table] children {}] 0]
    update
    check_equal highlighted [molinfo $adk get numreps] 2
    tab trajectory
    form trajectory,csv $scratch/last.csv
    press trajectory,run
    tab pair
    press compare
    pause 200
    set handles [list $::espdiff::gui::running $::espdiff::gui::trajectory_running]
    check "both run" {"" ni $handles}
    with_yes { ::espdiff::gui::close_window }
    pause 200
    check "gone" {![winfo exists $window]}
    foreach handle $handles { check "$handle is gone" {$handle ni [espdiff handles]} }
    check_equal "no highlight" [molinfo $adk get numreps] 1
    foreach {name _} {::vmd_frame . ::vmd_quit . ::vmd_molecule .} {
        check "no trace on $name" {![string match *gui* [trace info variable $name]]}
    }
    animate goto 0
}

test "opened again, in its home the settings" {
    set file [file join $env(HOME) .config espdiff window]
    check "kept" {[file exists $file]}
    espdiff gui
    update
    check_equal frames $::espdiff::gui::form(trajectory,frames) 0:10:end
    form trajectory,frames 5:5:
    set ::vmd_quit 1  ;# as VMD does before it ends
    set channel [open $file]
    check "kept when VMD is left" {[string match "*form trajectory,frames 5:5:\n*" [read $channel]]}
    close $channel
    destroy $window
    update
}

test "no callback failed" { check_equal errors $background {} }

espdiff delete all
finish
