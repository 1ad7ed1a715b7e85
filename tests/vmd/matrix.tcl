# matrix.tcl: frames of VMD's molecules as a matrix, parts under `parallel for`, and residues' values on VMD's atoms.
source [file join $env(ESPDIFF_TESTS) support.tcl]
package require espdiff

set quick {-grid-spacing 2}

# Before anything is loaded: VMD 1.9.4 reserves gigabytes for each frame of a DCD file (it asks the reader for a page
# size without an initial value), and a process of that size may not fork.
test "the example for VMD, in a VMD of its own, ends" {
    set example [file join $env(ESPDIFF_TESTS) .. .. docs examples matrix_vmd.tcl]
    set vmd [expr {[info exists env(VMD)] ? $env(VMD) : "vmd"}]
    exec $vmd -dispdev text -e $example -args [input traj_adk/adk.psf] [input traj_adk/adk_dims.dcd] 0:40:80 \
        $scratch/example {*}$quick </dev/null 2>@1
}

set mol [mol new [input traj_adk/adk.psf] type psf waitfor all]
mol addfile [input traj_adk/adk_dims.dcd] type dcd waitfor all $mol

test "frames of a molecule, each with each, with computed potentials" {
    set variants [list [list mol $mol frames 0:40:80 sel protein map {pme grid 2} group closed] \
        [list mol $mol frame 97 sel protein map {pme grid 2} label open]]
    set matrix [espdiff matrix $variants -output $scratch/adk {*}$quick]
    set labels {}
    foreach variant [espdiff result $matrix variants] { lappend labels [dict get $variant label] }
    check_equal labels $labels {adk.psf:0 adk.psf:40 adk.psf:80 open}
    check_equal pairs [espdiff result $matrix pairs] 12
    set single [espdiff compare [list mol $mol frame 40 sel protein map {pme grid 2}] \
        [list mol $mol frame 97 sel protein map {pme grid 2}] {*}$quick]
    check_equal "a cell is the comparison" [lindex [espdiff result $matrix metrics rms_difference values] 1 3] \
        [espdiff result $single rms_difference]
    check "unit" {[espdiff result $matrix potential_unit] eq "kT/e in vacuum"}
}

test "parts by VMD's parallel for, merged: the same bytes" {
    set ::variants [list [list mol $mol frames 0:40:80 sel protein]]
    espdiff matrix $::variants -output $scratch/whole {*}$quick
    proc part {i userdata} { espdiff matrix $::variants -output $::scratch/part -shard [expr {$i + 1}]/3 {*}$::quick }
    parallel for 0 2 part {}
    espdiff merge [glob $scratch/part.shard-*.state] -output $scratch/merged
    foreach ending {csv json} {
        set whole [open $scratch/whole.$ending]
        set merged [open $scratch/merged.$ending]
        check_equal $ending [read $merged] [read $whole]
        close $whole
        close $merged
    }
}

test "it gives what one process gives" {
    set variants [list [list mol $mol frames 0:40:80 sel protein map pme]]
    espdiff matrix $variants -output $scratch/one {*}$quick
    set one [open $scratch/one.csv]
    set example [open $scratch/example.csv]
    check_equal rows [read $example] [read $one]
    close $one
    close $example
}

test "residues' values in the user field of a frame, beta, and a PDB file" {
    set pair [espdiff compare [list mol $mol frame 0 sel protein map {pme grid 2}] \
        [list mol $mol frame 20 sel protein map {pme grid 2}] {*}$quick]
    set said [espdiff atoms $pair -quantity mean_signed_difference -field user2 -frame 5]
    check_equal unit [dict get $said unit] "kT/e in vacuum"
    check_equal molecule [dict get $said mol] $mol
    set n 0
    foreach residue [espdiff residues $pair] {
        if {[dict get $residue mean_signed_difference] eq ""} continue
        set selection [atomselect $mol "resid [dict get $residue number]" frame 5]
        foreach value [$selection get user2] {
            check_close "residue [dict get $residue number]" $value [dict get $residue mean_signed_difference] 1e-5
            incr n
        }
        $selection delete
    }
    check_equal atoms [dict get $said atoms] $n
    set elsewhere [atomselect $mol "resid 10" frame 6]
    check_equal "another frame" [lsort -unique [$elsewhere get user2]] 0.0
    $elsewhere delete
    espdiff atoms $pair -field user -frame all
    set last [atomselect $mol all frame last]
    check "all frames" {[lindex [lsort -real [$last get user]] end] > 0}
    $last delete
    espdiff atoms $pair -quantity mean_displacement_A -field beta -missing -1
    set all [atomselect $mol all]
    check "beta" {[lindex [lsort -real [$all get beta]] end] > 0}
    $all delete
    espdiff atoms $pair -file $scratch/b.pdb
    set copy [mol new $scratch/b.pdb waitfor all]
    check_equal "atoms of the file" [molinfo $copy get numatoms] [molinfo $mol get numatoms]
    mol delete $copy
}

test "what atoms refuses" {
    check_refused { espdiff atoms $pair -mol 99 } {ESPDIFF INPUT} "there is no molecule '99'"
    check_refused { espdiff atoms $pair -frame 999 } {ESPDIFF INPUT} "frame 999"
    set other [mol new [input ubq/ubq.pqr] waitfor all]
    set files [espdiff compare [list file [input ubq/ubq.pqr]] [list file [input ubq/ubq.pqr]] {*}$quick]
    check_refused { espdiff atoms $files } {ESPDIFF INPUT} "came from a file"
    check "named" {[dict get [espdiff atoms $files -mol $other] atoms] > 500}
    check_refused { espdiff plot $scratch/whole.csv } {ESPDIFF FORMAT} "column `frame`"
    espdiff delete all
}

finish
