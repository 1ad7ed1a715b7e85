# other_numbers.tcl: the window with states whose residues have other chains and numbers: what is chosen is highlighted in
# one state, and its partner in the other: by the map of residues of two trajectories, and by a cause of a difference.
source [file join $env(ESPDIFF_TESTS) support.tcl]
source [file join $env(ESPDIFF_TESTS) window_support.tcl]
package require espdiff

# Frames of two entries of the PDB, HIV protease; the second has another chain, and its numbers are higher by one.
foreach {name entry} {frames 1hhp others 3phv} {
    set $name [mol new [input pairs/$entry.pdb] type pdb waitfor all]
    mol addfile [input pairs/$entry.pdb] type pdb waitfor all [set $name]
}
set all [atomselect $others all]
$all set resid [lmap number [$all get resid] { expr {$number + 1} }]
$all set chain B
$all delete

# {chain resname resid} of what the last representation shows.
proc highlighted {mol} {
    set chosen [atomselect $mol [lindex [molinfo $mol get "{selection [expr {[molinfo $mol get numreps] - 1}]}"] 0]]
    set found [lsort -unique [$chosen get {chain resname resid}]]
    $chosen delete
    return $found
}

set window [espdiff_tk]
wm geometry $window 690x1000
update
tab trajectory
press trajectory,residues
form trajectory,mol "$frames: 1hhp.pdb" trajectory,sel protein trajectory,against "the same frame of" trajectory,map none \
    trajectory,csv $scratch/frames.csv
::espdiff::gui::choose_trajectory
form trajectory,other "$others: 3phv.pdb"
array set ::espdiff::gui::setting {grid-spacing 1.5}
press trajectory,run
wait_until {$::espdiff::gui::trajectory_running eq ""}

test "the table of residues knows the partners" {
    check_equal rows [llength $::espdiff::gui::trajectory_rows] 2
    set table [::espdiff::core::residue_map $scratch/frames.residues.csv]
    set place [lsearch -exact [dict get $table residues] "B:LEU 25"]
    check "the source is the other trajectory" {$place >= 0}
    check_equal "its partner" [lindex [dict get $table partners] $place] "A:LEU 24"
}

test "a click highlights the residue in the source and its partner in the frames, each by its own name" {
    form trajectory,metric [lindex [[widget trajectory,metric] cget -values] end]
    event generate [widget trajectory,metric] <<ComboboxSelected>>
    update
    set reps [list [molinfo $frames get numreps] [molinfo $others get numreps]]
    set place [lsearch -glob [dict get $::espdiff::gui::residue_table residues] "B:* 25"]
    event generate [widget trajectory,plot] <ButtonPress-1> -x [expr {int([::espdiff::gui::frame_x 0])}] \
        -y [expr {round([::espdiff::gui::residue_y $place])}]
    update
    check_equal "a representation more in each" [list [molinfo $frames get numreps] [molinfo $others get numreps]] \
        [lmap n $reps { expr {$n + 1} }]
    check_equal "in the source" [highlighted $others] {{B LEU 25}}
    check_equal "in the frames" [highlighted $frames] {{A LEU 24}}
    set told [[widget trajectory,point] cget -text]
    check "both names are told: $told" {[string match "Frame 0, B:LEU 25\u2192A:LEU 24: *" $told]}
    check_equal "frames of both" [list [molinfo $frames get frame] [molinfo $others get frame]] {0 0}
}

test "the highlights go with another run" {
    set reps [list [molinfo $frames get numreps] [molinfo $others get numreps]]
    ::espdiff::gui::forget_residue_map
    check_equal "one less in each" [list [molinfo $frames get numreps] [molinfo $others get numreps]] \
        [lmap n $reps { expr {$n - 1} }]
}

load_tim
set all [atomselect $target all]
$all set resid [lmap number [$all get resid] { expr {$number + 1} }]
$all set chain B
$all delete

test "a cause that the table leaves out is highlighted with its partner" {
    tab residues
    set comparison [espdiff compare [list mol $source map coulomb] [list mol $target map coulomb] -grid-spacing 2 \
        -causes "residue A:26"]
    ::espdiff::gui::show_results $comparison
    form residues,least 10000
    ::espdiff::gui::fill_residues
    update
    check_equal "residues in the table" [llength [[widget residues,table] children {}]] 0
    set causes [widget causes,table]
    dict for {item cause} $::espdiff::gui::cause_rows {
        if {[dict get $cause place source] ne "" && [dict get $cause place target] ne ""} break
    }
    set rotation [molinfo $source get rotate_matrix]
    $causes selection set $item
    update
    check "the view is rotated to it" {[molinfo $source get rotate_matrix] ne $rotation}
    set number [dict get $cause number]
    check_equal "in the source" [lindex [highlighted $source] 0 2] $number
    check_equal "in the target" [lreplace [lindex [highlighted $target] 0] 1 1] [list B [expr {$number + 1}]]
    form residues,least 0
}

test "no callback failed" { check_equal errors $background {} }

finish
