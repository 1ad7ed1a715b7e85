# fields.tcl: VMD's per-atom fields as fields: user and beta in pairs, matrices and trajectories.
source [file join $env(ESPDIFF_TESTS) support.tcl]
package require espdiff

set quick {-grid-spacing 2}
set mol [mol new [input traj_adk/adk.psf] type psf waitfor all]
mol addfile [input traj_adk/adk_dims.dcd] type dcd first 0 last 60 step 30 waitfor all $mol

# user and user2 are of a frame: 10 times its number, in user 0.5 times the residue's besides; beta is of the molecule.
set all [atomselect $mol all]
for {set frame 0} {$frame < 3} {incr frame} {
    $all frame $frame
    set values {}
    foreach resid [$all get resid] { lappend values [expr {0.5 * $resid + 10 * $frame}] }
    $all set user $values
    $all set user2 [expr {10 * $frame}]
}
$all set beta 7.25
$all delete

proc state {frame} { list mol $::mol frame $frame sel protein }

test "user differs by what was set in the frames, and beta not at all" {
    set pair [espdiff compare [state 0] [state 2] -field {user {} user2 {} b beta} {*}$quick]
    check_equal "signed difference" [espdiff result $pair fields user2 mean_signed_difference] 20.0
    check_close "with the residues" [espdiff result $pair fields user mean_signed_difference] 20 0.01
    check_equal beta [espdiff result $pair fields b mean_abs_difference] 0.0
    check_equal kind [espdiff result $pair fields user kind] given:user
    check "correlation" {[espdiff result $pair fields user correlation] > 0.9}
}

test "a matrix and a trajectory have the same numbers" {
    set pair [espdiff compare [state 0] [state 2] -field user {*}$quick]
    set there [espdiff result $pair fields user rms_difference]
    set matrix [espdiff matrix [list [list mol $mol frames all sel protein]] -output $scratch/user -field user {*}$quick]
    check_equal cell [lindex [espdiff result $matrix metrics user_rms_difference values] 0 2] $there
    set run [espdiff trajectory -mol $mol -sel protein -csv $scratch/rows.csv -reference {frame 0} -field user \
        -residues $scratch/residues.csv -residue-quantity user_mean_signed_difference {*}$quick]
    set rows [open $scratch/rows.csv]
    set lines [split [string trim [read $rows]] \n]
    close $rows
    foreach line $lines { if {![string match #* $line]} { lappend table [split $line ,] } }
    set column [lsearch [lindex $table 0] user_rms_difference]
    check "column" {$column > 0}
    check_equal row [lindex $table 3 $column] $there
    set residues [open $scratch/residues.csv]
    check_equal head [gets $residues] "# residues: user_mean_signed_difference"
    close $residues
}

test "what VMD's atoms do not have, and what is no number, is refused" {
    check_refused { espdiff compare [state 0] [state 1] -field {n name} {*}$quick } {ESPDIFF INPUT} "field name" \
        "which is no number"
    check_refused { espdiff compare [state 0] [state 1] -field given:nothing {*}$quick } {ESPDIFF INPUT} "field nothing" \
        "atomselect keywords"
    check_refused { espdiff compare [state 0] [state 1] -field hydrophobicty {*}$quick } {ESPDIFF INPUT} \
        "there is no field 'hydrophobicty'"
    check_refused {
        espdiff compare [state 0] [list file [input traj_adk/adk_open.pqr]] -field user {*}$quick
    } {ESPDIFF INPUT} "the target" "comes without values"
}

test "a field is drawn in the place of the potential, by its own scale" {
    set pair [espdiff compare [state 0] [state 2] -field {user {} charge {}} {*}$quick]
    espdiff draw $pair -field user
    set plan [dict get $::espdiff::drawn_plans $pair]
    check_equal quantity [dict get $plan color] user:difference
    check_equal title [dict get $plan title] "user: difference, target - source"
    check "range" {[dict get $plan high] >= 19.9 && [dict get $plan low] == -[dict get $plan high]}
    espdiff draw $pair -field charge -color source
    check_equal source [dict get $::espdiff::drawn_plans $pair color] charge:source
    set molecules [espdiff draw $pair -field charge -view linked]
    check "three panels" {[llength $molecules] >= 3}
    espdiff undraw $pair
    check_refused { espdiff draw $pair -field hydrophobicity } {ESPDIFF INPUT} "has no field 'hydrophobicity'; it has user, charge"
    check_refused { espdiff draw $pair -field user -color slip } {ESPDIFF INPUT} "'slip' is no quantity of a field"
    set k [espdiff map $pair -quantity difference -mol $mol]
    check "map of the potential" {$k >= 0}
}

finish
