# pmepot_parity.tcl: `espdiff potential --compatible` against VMD's own PMEPot on the same atoms: an orthorhombic cell, a
# truncated octahedron, and a molecule without a cell.
source [file join $env(ESPDIFF_TESTS) support.tcl]
package require pmepot

# The bar of the design: the largest deviation over the largest potential.
set limit 1e-5

# Writes charges and places with all the digits of VMD's single precision.
proc write_full_pqr {molid path} {
    set all [atomselect $molid all]
    set file [open $path w]
    set serial 0
    foreach atom [$all get {x y z charge}] {
        lassign $atom x y z charge
        puts $file [format "ATOM %d X MOL %d %.9g %.9g %.9g %.9g 1.0" [incr serial] [expr {$serial % 9999}] $x $y $z $charge]
    }
    close $file
    $all delete
}

# Header and values of a DX file: {counts origin deltas values}
proc read_dx_file {path} {
    set file [open $path]
    set text [read $file]
    close $file
    regexp {counts (\d+) (\d+) (\d+)} $text -> nx ny nz
    regexp {origin ([^\n]+)} $text -> origin
    set deltas {}
    foreach {whole delta} [regexp -all -inline {delta ([^\n]+)} $text] { lappend deltas $delta }
    set first [expr {[string first "data follows" $text] + 12}]
    return [list [list $nx $ny $nz] $origin $deltas [lrange [string range $text $first [expr {[string first attribute $text] - 1}]] 0 end]]
}

# The largest difference over the largest value; lattices must agree to PMEPot's six digits.
proc deviation {ours theirs} {
    lassign [read_dx_file $ours] our_counts our_origin our_deltas our_values
    lassign [read_dx_file $theirs] their_counts their_origin their_deltas their_values
    check_equal "grid sizes" $our_counts $their_counts
    foreach a [concat $our_origin {*}$our_deltas] b [concat $their_origin {*}$their_deltas] {
        check "lattice" {abs($a - $b) < 1e-4}
    }
    check_equal "number of values" [llength $our_values] [llength $their_values]
    set largest 0.0
    set difference 0.0
    foreach a $our_values b $their_values {
        set largest [expr {max($largest, abs($b))}]
        set difference [expr {max($difference, abs($a - $b))}]
    }
    return [expr {$difference / $largest}]
}

# Runs both on the frame that is shown; returns the deviation. `cell` are further options of ours.
proc compare_with_pmepot {name molid cell args} {
    global scratch env
    set theirs [file join $scratch $name-pmepot.dx]
    set ours [file join $scratch $name-espdiff.dx]
    set pqr [file join $scratch $name.pqr]
    pmepot -mol $molid -frames now -dxfile $theirs -loadmol none {*}$args
    write_full_pqr $molid $pqr
    exec $env(ESPDIFF) potential $pqr -o $ours --compatible -q --device cpu {*}$cell
    return [deviation $ours $theirs]
}

proc own_cell {molid} { return [list --cell [::PMEPot::get_cell_from_vmd $molid]] }

test "a cubic cell with water and a net charge: DHFR" {
    set molid [mol new [input box_dhfr_jac/JAC.prmtop] type parm7]
    mol addfile [input box_dhfr_jac/JAC_from_ncrst.dcd] type dcd waitfor all $molid
    set found [compare_with_pmepot dhfr $molid [own_cell $molid]]
    note "    deviation $found"
    check "deviation" {$found <= $limit}
    set found [compare_with_pmepot dhfr_coarse $molid [concat [own_cell $molid] --grid 2.3 --ewaldfactor 0.35] -grid 2.3 -ewaldfactor 0.35]
    note "    deviation at 2.3 A and 0.35 / A $found"
    check "deviation at 2.3 A and 0.35 / A" {$found <= $limit}
    mol delete $molid
}

test "a truncated octahedron, first and last frame: tz2" {
    set molid [mol new [input box_tz2/tz2.truncoct.parm7] type parm7]
    mol addfile [input box_tz2/tz2.truncoct_from_nc.dcd] type dcd waitfor all $molid
    foreach frame {0 9} {
        animate goto $frame
        set found [compare_with_pmepot tz2_$frame $molid [own_cell $molid]]
        note "    deviation of frame $frame $found"
        check "deviation of frame $frame" {$found <= $limit}
    }
    mol delete $molid
}

test "no cell: ubiquitin in a box that each makes for itself" {
    set molid [mol new [input ubq/ubq.psf]]
    mol addfile [input ubq/ubq.pdb] waitfor all $molid
    foreach {name ours theirs} {default {} {} padded {--pad 7.5} {-pad 7.5} sized {--grid {60 54 64}} {-grid {60 54 64}}} {
        set found [compare_with_pmepot ubq_$name $molid $ours {*}$theirs]
        note "    deviation, $name, $found"
        check "deviation, $name" {$found <= $limit}
    }
    # What rounding costs: VMD's own PQR has three decimals.
    set all [atomselect $molid all]
    $all writepqr [file join $scratch rounded.pqr]
    $all delete
    exec $env(ESPDIFF) potential [file join $scratch rounded.pqr] -o [file join $scratch rounded.dx] --compatible -q --device cpu
    set found [deviation [file join $scratch rounded.dx] [file join $scratch ubq_default-pmepot.dx]]
    note "    deviation with VMD's own PQR $found"
    check "deviation with VMD's own PQR" {$found < 1e-3}
    mol delete $molid
}

test "the mean over frames in one cell: tz2" {
    set molid [mol new [input box_tz2/tz2.truncoct.parm7] type parm7]
    mol addfile [input box_tz2/tz2.truncoct_from_nc.dcd] type dcd first 0 last 3 waitfor all $molid
    animate goto 0
    set cell [::PMEPot::get_cell_from_vmd $molid]
    set theirs [file join $scratch mean-pmepot.dx]
    pmepot -mol $molid -frames 0:end -cell $cell -dxfile $theirs -loadmol none
    set frames [open [file join $scratch mean.pqr] w]
    for {set frame 0} {$frame < 4} {incr frame} {
        animate goto $frame
        write_full_pqr $molid [file join $scratch one.pqr]
        set one [open [file join $scratch one.pqr]]
        puts $frames "MODEL [expr {$frame + 1}]\n[read $one]ENDMDL"
        close $one
    }
    close $frames
    exec $env(ESPDIFF) potential [file join $scratch mean.pqr] -o [file join $scratch mean.dx] --compatible --cell $cell -q --device cpu
    set found [deviation [file join $scratch mean.dx] $theirs]
    note "    deviation $found"
    check "deviation" {$found <= $limit}
    mol delete $molid
}

finish
