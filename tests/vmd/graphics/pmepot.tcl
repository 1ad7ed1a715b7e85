# pmepot.tcl: VMD's own PMEPot on two states of ubiquitin: the manual's example script as it stands.
source [file join $env(ESPDIFF_TESTS) support.tcl]

test "the example runs, its numbers are sound, and its picture is coloured" {
    set env(UBQ) [file dirname [input ubq/ubq.psf]]
    set env(UBQ_PICTURE) [file join $scratch ubiquitin.tga]
    source [file join $env(ESPDIFF_TESTS) .. .. docs examples pmepot_ubiquitin.tcl]
    set comparison [lindex [espdiff handles] 0]
    check_equal "unit" [espdiff result $comparison potential_unit] "kT/e in vacuum"
    # The example takes away charges and leaves the atoms: the only reason against it.
    set reasons [espdiff result $comparison certificate reasons]
    check "the reasons: $reasons" {[llength $reasons] == 1 && [string match "*net charges that name and hydrogens*" $reasons]}
    check_equal "the mapping" [espdiff result $comparison certificate converged] 1
    # 11 carboxylates without their charge: the potential rises nearly everywhere.
    check "the potential rises" {[espdiff result $comparison mean_signed_difference] > 1}
    check "and only rises" {[espdiff result $comparison mean_abs_difference] < 1.2 * [espdiff result $comparison mean_signed_difference]}
    check "picture" {[file size $env(UBQ_PICTURE)] > 100000}
}

finish
