# potential.tcl: potentials computed from VMD's charges: as PMEPot's in its own mode, in the cell of each frame, averaged,
# and in comparisons without any map.
source [file join $env(ESPDIFF_TESTS) support.tcl]
package require espdiff
package require pmepot

# A data set of a molecule at all its atoms.
proc at_atoms {mol k} {
    set all [atomselect $mol all]
    set values [$all get interpvol$k]
    $all delete
    return $values
}

proc largest {values} {
    set most 0
    foreach value $values { set most [expr {max($most, abs($value))}] }
    return $most
}

proc largest_difference {a b} {
    set most 0
    foreach x $a y $b { set most [expr {max($most, abs($x - $y))}] }
    return $most
}

set ubq [mol new [input ubq/ubq.psf] type psf waitfor all]
mol addfile [input ubq/ubq.pdb] type pdb waitfor all $ubq
mol top $ubq

test "compatible: PMEPot's map of ubiquitin, read back from VMD at its atoms" {
    pmepot -mol $ubq -grid 1.0 -ewaldfactor 0.25 -loadmol same
    set result [espdiff potential -mol $ubq -grid 1.0 -ewaldfactor 0.25 -compatible 1]
    check_equal "volumes" [dict get $result volumes] 1
    set theirs [at_atoms $ubq 0]
    set ours [at_atoms $ubq 1]
    # PMEPot's went through a text file of six digits.
    check "the same" {[largest_difference $theirs $ours] < 2e-5 * [largest $theirs]}
    note "    largest deviation [expr {[largest_difference $theirs $ours] / [largest $theirs]}] of the largest potential"
}

test "where PMEPot's numbers are not wanted, the map is another" {
    espdiff potential -mol $ubq -grid 1.0
    check "differs" {[largest_difference [at_atoms $ubq 0] [at_atoms $ubq 2]] > 1e-3 * [largest [at_atoms $ubq 0]]}
}

test "a periodic cell: DHFR in water, in its own cell" {
    set dhfr [mol new [input box_dhfr_jac/JAC.prmtop] type parm7 waitfor all]
    mol addfile [input box_dhfr_jac/JAC_from_ncrst.dcd] type dcd waitfor all $dhfr
    set result [espdiff potential -mol $dhfr]
    note "    [molinfo $dhfr get numatoms] atoms: [dict get $result seconds] s with the way into VMD"
    set comparison [espdiff compare [list mol $dhfr sel protein map pme] [list mol $dhfr sel protein map pme]]
    check "a molecule differs little from itself" {[espdiff result $comparison mean_abs_difference] < 0.1}
    check_equal "unit" [espdiff result $comparison potential_unit] kT/e
    check_equal "nothing lies outside a periodic map" [espdiff result $comparison n_vertices_outside_map source] 0
    # Its surface alone sees another potential than all the water and ions around it give.
    set alone [espdiff compare [list mol $dhfr sel protein map {pme sel protein}] [list mol $dhfr sel protein map pme] \
        -trust-maps 1]
    check "the water counts" {[espdiff result $alone mean_abs_difference] > 0.1}
    espdiff delete all
}

test "a trajectory: the cell and the coordinates of each frame, mean and variance" {
    set tz2 [mol new [input box_tz2/tz2.truncoct.parm7] type parm7 waitfor all]
    mol addfile [input box_tz2/tz2.truncoct_from_nc.dcd] type dcd waitfor all $tz2
    set result [espdiff potential -mol $tz2 -frames all -align backbone -variance 1 -error 1 -block 2 -grid 1.5 \
        -dxfile $scratch/tz2.dx]
    check_equal "frames" [dict get $result frames] [molinfo $tz2 get numframes]
    check_equal "maps" [dict get $result volumes] {0 1 2}
    check_equal "files" [llength [dict get $result files]] 3
    foreach file [dict get $result files] { check "$file" {[file size $file] > 10000} }
    # Not by `interpvol`, which VMD 1.9.4 gets wrong in cells that are not rectangular.
    set channel [open $scratch/tz2.variance.dx]
    set n 0
    while {[gets $channel line] >= 0} {
        if {![regexp {^[-0-9]} $line]} continue
        foreach value $line { check "variance" {$value >= 0}; incr n }
    }
    close $channel
    check "values" {$n > 10000}
    check_refused {espdiff potential -mol $tz2 -frames 0:1 -variance 1 -dxfile $scratch/tz2.dx} {ESPDIFF INPUT} \
        "tz2.dx exists; -overwrite 1 replaces it"
    file delete $scratch/tz2.dx
    check_refused {espdiff potential -mol $tz2 -frames 0:1 -variance 1 -dxfile $scratch/tz2.dx} {ESPDIFF INPUT} \
        "tz2.variance.dx exists; -overwrite 1 replaces it"
    set rows [espdiff trajectory -mol $tz2 -sel protein -frames 0:4:8 -map {pme grid 1.0} -csv $scratch/tz2.csv]
    check_equal "rows" [dict get $rows rows] 3
    mol delete $tz2
}

test "a map for each frame: data sets and files by the frames' numbers, and their mean" {
    set tz2 [mol new [input box_tz2/tz2.truncoct.parm7] type parm7 waitfor all]
    mol addfile [input box_tz2/tz2.truncoct_from_nc.dcd] type dcd waitfor all $tz2
    set result [espdiff potential -mol $tz2 -frames 0:4:8 -averaging each -grid 2 -dxfile $scratch/each.dx]
    check_equal "volumes" [dict get $result volumes] {0 1 2}
    set names {}
    foreach file [dict get $result files] { lappend names [file tail $file] }
    check_equal "files" $names {each.0000.dx each.0004.dx each.0008.dx}
    # Each is the map of that frame alone, in its own cell, on the first frame's lattice; the first one's exactly.
    espdiff potential -mol $tz2 -frames 0 -grid 2 -loadmol none -dxfile $scratch/first.dx
    set texts {}
    foreach name {each.0000 first each.0004} {
        set channel [open $scratch/$name.dx]
        lappend texts [regsub -all -line {^(#|object "|attribute|component).*$} [read $channel] ""]
        close $channel
    }
    check "the first frame's" {[lindex $texts 0] eq [lindex $texts 1]}
    check "another frame's" {[lindex $texts 0] ne [lindex $texts 2]}
    set result [espdiff potential -mol $tz2 -frames 0:4:8 -averaging each -variance 1 -grid 2 -loadmol new]
    check_equal "with the variance" [dict get $result volumes] {0 1 2 3}
    mol delete [dict get $result mol]
    check_refused {espdiff potential -mol $tz2 -averaging some} {ESPDIFF INPUT} "mean or each"
    check_equal "nothing is left" [list [::espdiff::core::handles] [::espdiff::core::volumes]] {{} {}}
    mol delete $tz2
}

test "frames of a molecule that the cell's border cuts: the mean of the whole one" {
    set tz2 [mol new [input box_tz2/tz2.truncoct.parm7] type parm7 waitfor all]
    mol addfile [input box_tz2/tz2.truncoct_from_nc.dcd] type dcd first 0 last 1 waitfor all $tz2
    set whole [espdiff potential -mol $tz2 -frames all -align backbone -grid 2 -loadmol none -dxfile $scratch/whole.dx]
    # The second frame's residues from 6 on in the next cell along the first edge.
    set half [atomselect $tz2 "protein and resid >= 6" frame 1]
    $half moveby [list [molinfo $tz2 get a frame 1] 0 0]
    $half delete
    espdiff potential -mol $tz2 -frames all -align backbone -grid 2 -loadmol none -dxfile $scratch/cut.dx
    set lists {}
    foreach name {whole cut} {
        set channel [open $scratch/$name.dx]
        set values {}
        while {[gets $channel line] >= 0} { if {[regexp {^[-0-9]} $line]} { lappend values {*}$line } }
        close $channel
        lappend lists $values
    }
    check "values" {[llength [lindex $lists 0]] > 1000}
    check "the same mean" {[largest_difference {*}$lists] < 1e-3 * [largest [lindex $lists 0]]}
    mol delete $tz2
}

test "a cell from a NAMD file is the same cell given" {
    set channel [open $scratch/cell.xsc w]
    puts $channel "# NAMD extended system configuration output file"
    puts $channel "#\$LABELS step a_x a_y a_z b_x b_y b_z c_x c_y c_z o_x o_y o_z"
    puts $channel "0 60 0 0 0 60 0 0 0 64 20 20 18"
    close $channel
    espdiff potential -mol $ubq -loadmol none -xscfile $scratch/cell.xsc -dxfile $scratch/xsc.dx
    espdiff potential -mol $ubq -loadmol none -cell {{20 20 18} {60 0 0} {0 60 0} {0 0 64}} -dxfile $scratch/cell.dx
    set texts {}
    foreach name {xsc cell} {
        set channel [open $scratch/$name.dx]
        lappend texts [read $channel]
        close $channel
    }
    check "the same map" {[lindex $texts 0] eq [lindex $texts 1]}
    check_refused {espdiff potential -mol $ubq -xscfile $scratch/none.xsc} {ESPDIFF IO} "none.xsc"
}

test "every option of Poisson-Boltzmann's table, as the command line has it" {
    set molecule [mol new [input pqr_pdb2pqr/1AJJ_pH7_AMBER.pqr] type pqr waitfor all]
    set options {-ionic-strength 0.05 -solute-dielectric 4 -dielectric-boundary vdw -pb-spacing 1.5 -pb-padding 8
        -far-boundary debye-hueckel}
    espdiff potential -mol $molecule -method pb {*}$options -loadmol none -dxfile $scratch/vmd.dx
    set words {}
    foreach {option value} $options { lappend words -$option $value }
    exec $env(ESPDIFF) potential [input pqr_pdb2pqr/1AJJ_pH7_AMBER.pqr] --method pb {*}$words -q -o $scratch/program.dx
    set lists {}
    foreach name {vmd program} {
        set channel [open $scratch/$name.dx]
        set values {}
        while {[gets $channel line] >= 0} { if {[regexp {^[-0-9]} $line]} { lappend values {*}$line } }
        close $channel
        lappend lists $values
    }
    check "values" {[llength [lindex $lists 0]] > 1000}
    # VMD has single precision coordinates.
    check "the same map" {[largest_difference {*}$lists] < 1e-3 * [largest [lindex $lists 0]]}
    check_refused {espdiff potential -mol $molecule -method pb -loadmol none -dxfile $scratch/x.dx -ionic-strength -1} \
        {ESPDIFF INPUT} "'-1' is not a number from 0 to 100"
    check_refused {espdiff potential -mol $molecule -method pb -loadmol none -dxfile $scratch/x.dx -ewaldfactor 0.3} \
        {ESPDIFF INPUT} "is an option of the potential pme, and the potential is pb"
    check_refused {espdiff potential -mol $molecule -method pb -ionic_strength 0.1} {ESPDIFF INPUT} \
        "did you mean -ionic-strength?"
    check_equal "nothing was written" [glob -nocomplain $scratch/x.dx*] {}
    mol delete $molecule
}

test "what cannot be computed is refused with what to do" {
    set bare [mol new [input ubq/ubq.pdb] type pdb waitfor all]
    check_refused {espdiff potential -mol $bare} {ESPDIFF INPUT} "have no charges" "PSF"
    check_refused {espdiff potential -mol $ubq -sel "resid 500"} {ESPDIFF INPUT} "no atom of the selection"
    check_refused {espdiff potential -mol $ubq -variance 1} {ESPDIFF INPUT} "needs 2 frames"
    check_refused {espdiff potential -mol $ubq -loadmol none} {ESPDIFF INPUT} "-dxfile"
    check_refused {espdiff potential -mol $ubq -grid {8 8}} {ESPDIFF INPUT} "three numbers"
    check_refused {espdiff potential -mol $ubq -spline 3} {ESPDIFF INPUT} "3"
    check_refused {espdiff potential -mol 99} {ESPDIFF INPUT} "there is no molecule '99'"
    check_equal "nothing is left" [list [::espdiff::core::handles] [::espdiff::core::volumes]] {{} {}}
}

finish
