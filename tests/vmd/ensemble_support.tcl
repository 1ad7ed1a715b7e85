# ensemble_support.tcl: the simulations of tests/data/ensembles as molecules of VMD.

set folder [file normalize [file join $env(ESPDIFF_TESTS) .. data ensembles]]

# By Tcl itself where it can: a large VMD may not fork.
proc unpack {from to} {
    if {[info commands zlib] eq ""} { exec gzip -dc $from > $to; return }
    set in [open $from rb]
    set out [open $to wb]
    puts -nonewline $out [zlib gunzip [read $in]]
    close $in
    close $out
}

# A run with charges; VMD does not read compressed files.
proc load_run {state number {step 20}} {
    global folder env
    set pdb $env(SCRATCH)/$state$number.pdb
    if {![file exists $pdb]} { unpack $folder/trpcage_${state}_$number.pdb.gz $pdb }
    set mol [mol new $pdb type pdb first 0 last 99 step $step waitfor all]
    # Charges and radii of the PQR file's atoms of the same names.
    set pqr [mol new $folder/trpcage_$state.pqr type pqr waitfor all]
    set from [atomselect $pqr all]
    foreach atom [$from get {resid name}] values [$from get {charge radius}] { set known($atom) $values }
    set to [atomselect $mol all]
    set values {}
    foreach atom [$to get {resid name}] { lappend values $known($atom) }
    $to set {charge radius} $values
    $from delete
    $to delete
    mol delete $pqr
    mol rename $mol ${state}_$number
    return $mol
}
