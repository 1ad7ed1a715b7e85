# ensemble_tab.tcl: the window's tab for ensembles in a real VMD, by its widgets: molecules, a run, patches, frames, closing.
source [file join $env(ESPDIFF_TESTS) support.tcl]
package require espdiff
source [file join $env(ESPDIFF_TESTS) window_support.tcl]
source [file join $env(ESPDIFF_TESTS) ensemble_support.tcl]

foreach state {wild mutant} { foreach number {1 2 3 4} { lappend mols [load_run $state $number] } }
set window [espdiff gui]
tab ensemble
array set ::espdiff::gui::setting {grid-spacing 1.6}
proc message_line {} { [widget ensemble,message] cget -text }

test "a wrong selection is refused before it is in the list" {
    form ensemble,mol "[lindex $mols 0]: [molinfo [lindex $mols 0] get name]" ensemble,sel protin
    press ensemble,add
    check "said: [message_line]" {[string match "Atoms: the selection 'protin' of molecule * not understood by VMD*" [message_line]]}
    check_equal "nothing is added" [[widget ensemble,list] children {}] {}
}

test "molecules are replicates of the group that is named" {
    foreach mol $mols {
        form ensemble,group [expr {[lsearch $mols $mol] < 4 ? "wild" : "mutant"}] \
            ensemble,mol "$mol: [molinfo $mol get name]" ensemble,sel all
        press ensemble,add
    }
    set cells {}
    foreach item [[widget ensemble,list] children {}] { lappend cells [lrange [[widget ensemble,list] item $item -values] 0 1] }
    check_equal cells $cells {{wild wild_1} {wild wild_2} {wild wild_3} {wild wild_4} {mutant mutant_1}\
        {mutant mutant_2} {mutant mutant_3} {mutant mutant_4}}
    check "run" {[[widget ensemble,compute] instate !disabled]}
}

test "fits a screen of 1280 x 800" {
    set size [list [winfo reqwidth $window] [winfo reqheight $window]]
    check "width" {[lindex $size 0] <= 720}
    check "height" {[lindex $size 1] <= 760}
}

test "the run, stopped and gone on with" {
    form ensemble,potential "Coulomb, vacuum" ensemble,output $scratch/tab
    press ensemble,compute
    wait_until {[regexp {^frame ([3-9]|1\d) of 40} [[widget ensemble,message] cget -text]]}
    press ensemble,cancel
    wait_until {$::espdiff::gui::ensemble_running eq ""}
    check "said" {[string match "Stopped. With*resume*" [[widget ensemble,message] cget -text]]}
    form ensemble,resume 1
    press ensemble,compute
    wait_until {$::espdiff::gui::ensemble_running eq ""}
    check "done" {[string match "40 frames in *Written: tab.json*" [[widget ensemble,message] cget -text]]}
    set h $::espdiff::gui::ensemble_shown
    check "resumed" {[espdiff result $h resumed] >= 2}
    check "answer" {[string match "*\nMean absolute difference*" [[widget ensemble,answer] cget -text]]}
}

test "the difference is drawn on the template's molecule, at its frame" {
    check "drawn" {[llength [::espdiff::drawing_of $h]] >= 1}
    lassign [::espdiff::ensemble_template $h] mol frame
    check "template" {$mol in $mols}
    check_equal frame [molinfo $mol get frame] $frame
    foreach other $mols { check_equal "shown $other" [molinfo $other get displayed] [expr {$other == $mol}] }
    set all [atomselect $mol all]
    set center [measure center $all]
    $all delete
    check "near the surface" {[veclength [vecsub $center [dict get [lindex [espdiff patches $h] 0] peak_A]]] < 25}
}

test "a click on a patch draws it alone from its front, and its series" {
    set patches [[widget ensemble,patches] children {}]
    check "patches" {[llength $patches] > 0}
    set before [molinfo [lindex $mols 0] get rotate_matrix]
    [widget ensemble,patches] selection set [lindex $patches 0]
    update
    check_equal chosen $::espdiff::gui::ensemble_patch 1
    check "turned" {[molinfo [lindex $mols 0] get rotate_matrix] ne $before}
    lassign [::espdiff::ensemble_template $h] mol
    set all [atomselect $mol all]
    set away [vecsub [dict get [lindex [espdiff patches $h] 0] peak_A] [measure center $all]]
    $all delete
    lassign [vecnorm [vectrans [lindex [molinfo $mol get rotate_matrix] 0] $away]] x y z
    check "in front" {$z > 0.999}
    set key [dict get [dict get $::espdiff::drawn_options $h] patch]
    check_equal "drawn patch" $key 1
    check_equal runs [llength [[widget ensemble,plot] find withtag run]] 8
    check_equal means [llength [[widget ensemble,plot] find withtag mean]] 2
}

test "the frame under the pointer: its value, and a click shows it" {
    set x [expr {int([::espdiff::gui::series_x 23])}]
    event generate [widget ensemble,plot] <Motion> -x $x -y 60
    update
    check "told" {[string match "mutant, mutant_1, frame 3: * kT/e*click*" [[widget ensemble,point] cget -text]]}
    event generate [widget ensemble,plot] <ButtonPress-1> -x $x -y 60
    update
    check_equal frame [molinfo [lindex $mols 4] get frame] 3
    check_equal shown [molinfo [lindex $mols 4] get displayed] 1
    check_equal hidden [molinfo [lindex $mols 0] get displayed] 0
    foreach mol $mols { mol on $mol }
}

test "all again, and the script that repeats it" {
    press ensemble,draw
    check_equal chosen $::espdiff::gui::ensemble_patch ""
    set script [::espdiff::gui::session_text]
    foreach words {"espdiff ensemble \$groups" "mol \$mol" "espdiff draw \$ensemble -patch 0" "-map coulomb"} {
        check "words" {[string first $words $script] >= 0}
    }
}

test "a molecule that is deleted during the run ends it with a message" {
    form ensemble,output $scratch/gone ensemble,resume 0
    array set ::espdiff::gui::setting {grid-spacing 0.8}
    press ensemble,compute
    wait_until {[regexp {^frame ([2-9]|1\d) of 40} [[widget ensemble,message] cget -text]]}
    mol delete [lindex $mols 7]
    mol delete [lindex $mols 0]
    wait_until {$::espdiff::gui::ensemble_running eq ""}
    check "said" {[string match "*was deleted during the run*" [[widget ensemble,message] cget -text]]}
}

test "closing the window during a run" {
    form ensemble,output $scratch/last
    set ::espdiff::gui::replicates [lrange $::espdiff::gui::replicates 1 3]
    ::espdiff::gui::show_replicates
    press ensemble,compute
    pause 500
    set handle $::espdiff::gui::ensemble_running
    check "running" {$handle ne ""}
    destroy $window
    update
    check "gone" {$handle ni [espdiff handles]}
    check_equal background $background {}
}

espdiff delete all
finish
