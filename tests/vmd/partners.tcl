# partners.tcl: residues are found by the result's pairing in molecules whose numbers and chains differ.
source [file join $env(ESPDIFF_TESTS) support.tcl]
source [file join $env(ESPDIFF_TESTS) window_support.tcl]
package require espdiff

load_tim
# As between two entries of the PDB: other numbers, another chain.
set all [atomselect $target all]
$all set resid [lmap number [$all get resid] { expr {$number + 1} }]
$all set chain B
$all delete
set comparison [espdiff compare [list mol $source map 0] [list mol $target map 0] -grid-spacing 2]
foreach row [espdiff residues $comparison] { if {[dict get $row number] == 26} break }

# Residues of the last representation, the highlight.
proc highlighted {mol} {
    set rep [expr {[molinfo $mol get numreps] - 1}]
    set chosen [atomselect $mol [lindex [molinfo $mol get "{selection $rep}"] 0]]
    set found [lsort -unique [$chosen get {chain resname resid}]]
    $chosen delete
    return $found
}

test "a row names its partner" {
    check_equal number [dict get $row target_number] [expr {[dict get $row number] + 1}]
    check_equal chain [dict get $row target_chain] B
    check_equal "a mutation" [dict get $row target_name] ALA
    check "named: [::espdiff::residue_name $row]" {[regexp {^A:\w+26->B:ALA27$} [::espdiff::residue_name $row]]}
}

test "a highlight is of the residue and of its partner" {
    check_equal molecules [espdiff highlight $comparison [list [dict get $row index]]] [list $source $target]
    set own [lindex [highlighted $source] 0]
    check_equal source [lindex $own 2] 26
    check_equal target [highlighted $target] [list [list B [dict get $row target_name] 27]]
    espdiff highlight $comparison {}
}

test "a residue's value is on its partner's atoms" {
    foreach {mol number} [list $source 26 $target 27] {
        set carried [espdiff atoms $comparison -mol $mol -quantity mean_abs_difference]
        set chosen [atomselect $mol "resid $number"]
        set value [lindex [$chosen get user] 0]
        $chosen delete
        check_close "molecule $mol" $value [dict get $row mean_abs_difference] 1e-4
    }
}

test "magnitudes: 0 is in the middle of VMD's colour scale, and the share can be carried" {
    set carried [espdiff atoms $comparison -mol target -quantity share -show 1]
    lassign [mol scaleminmax $target 0] low high
    check "symmetric" {$high > 0 && abs($low + $high) < 1e-6 * $high}
    check_close "the largest share" $high [dict get $carried max] 1e-4
    espdiff uncolor $comparison
}

finish
