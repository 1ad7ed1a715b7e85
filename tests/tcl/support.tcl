# support.tcl: what every test file begins with: the package, made and real inputs, a scratch folder, the exit status.

# Made structures are no proteins that PDB2PQR could prepare: without it, shapes alone are compared.
set env(ESPDIFF_PDB2PQR) /no/such/program
#
# ESPDIFF_TCL_PACKAGE names the folder with the package's pkgIndex.tcl, ESPDIFF_DATA that of the real inputs.
package require tcltest 2.2
namespace import -force ::tcltest::test

set repository [file normalize [file join [file dirname [info script]] .. ..]]
if {![info exists env(ESPDIFF_TCL_PACKAGE)]} {
    set env(ESPDIFF_TCL_PACKAGE) [lindex [glob -nocomplain [file join $repository build vmd tcl espdiff*]] end]
}
lappend auto_path $env(ESPDIFF_TCL_PACKAGE)
package require espdiff

set data [expr {[info exists env(ESPDIFF_DATA)] ? $env(ESPDIFF_DATA) : [file join $repository .. shared data]}]
::tcltest::testConstraint data [file isdirectory $data]
::tcltest::testConstraint gemmi [dict get [::espdiff::core::build] gemmi]
if {![file isdirectory $data]} {
    puts "MESSAGE: SKIPPED: real inputs are absent; set ESPDIFF_DATA to their folder"
}

set scratch [file join [expr {[info exists env(TMPDIR)] ? $env(TMPDIR) : "/tmp"}] espdiff-tcl-test-[pid]]
file mkdir $scratch
cd $scratch
set env(XDG_CONFIG_HOME) [file join $scratch config]  ;# the user's own settings of the window are not touched

proc write_file {name text} {
    set channel [open $name w]
    puts -nonewline $channel $text
    close $channel
    return $name
}

proc read_file {name} {
    set channel [open $name]
    set text [read $channel]
    close $channel
    return $text
}

# A molecule of eight atoms, two residues, bent by `bend` Angstrom at its end; bonds have a backbone's lengths.
proc atom_positions {bend} {
    set positions {}
    for {set i 0} {$i < 8} {incr i} {
        set y [expr {0.74 * ($i % 2) + $bend * $i * $i / 49.0}]
        lappend positions [list [expr {1.23 * $i}] $y [expr {0.25 * ($i % 3)}]]
    }
    return $positions
}

set atom_names {N CA C O N CA C O}

proc write_pqr {name bend} {
    global atom_names
    set lines {}
    set i 0
    foreach position [atom_positions $bend] atom $atom_names {
        set residue [expr {$i / 4 + 1}]
        lappend lines [format "ATOM  %5d  %-3s %s %s %3d    %8.3f%8.3f%8.3f %7.4f %6.4f" [incr i] $atom \
            [expr {$residue == 1 ? "ALA" : "GLY"}] A $residue {*}$position [expr {$i % 2 ? 0.4 : -0.4}] 1.7]
    }
    return [write_file $name "[join $lines \n]\nEND\n"]
}

# Models that bend more and more.
proc write_models {name n} {
    global atom_names
    set text ""
    for {set model 1} {$model <= $n} {incr model} {
        append text [format "MODEL     %4d\n" $model]
        set i 0
        foreach position [atom_positions [expr {0.2 * ($model - 1)}]] atom $atom_names {
            set residue [expr {$i / 4 + 1}]
            append text [format "ATOM  %5d  %-3s %s %s%4d    %8.3f%8.3f%8.3f  1.00  0.00           %s\n" [incr i] $atom \
                [expr {$residue == 1 ? "ALA" : "GLY"}] A $residue {*}$position [string index $atom 0]]
        }
        append text "ENDMDL\n"
    }
    return [write_file $name "${text}END\n"]
}

# A potential that rises by `slope` kT/e per Angstrom along x, around the molecule.
proc write_map {name slope} {
    set n {13 9 9}
    lassign $n nx ny nz
    set text "object 1 class gridpositions counts $n\norigin -6 -8 -8\ndelta 2 0 0\ndelta 0 2 0\ndelta 0 0 2\n"
    append text "object 2 class gridconnections counts $n\n"
    append text "object 3 class array type double rank 0 items [expr {$nx * $ny * $nz}] data follows\n"
    set values {}
    for {set i 0} {$i < $nx} {incr i} {
        for {set j 0} {$j < $ny * $nz} {incr j} { lappend values [expr {$slope * (2.0 * $i - 6 - 5)}] }
    }
    return [write_file $name "$text[join $values \n]\nattribute \"dep\" string \"positions\"\n"]
}

# {message errorcode} of a script that must fail.
proc refused {script} {
    if {![catch { uplevel 1 $script } message options]} { error "not refused; it returned '$message'" }
    return "$message | [dict get $options -errorcode]"
}

proc finish {} {
    global scratch
    upvar #0 ::tcltest::numTests n
    set failed [expr {$n(Failed) > 0 || $n(Total) == 0}]
    espdiff delete all
    cd /
    file delete -force $scratch
    ::tcltest::testConstraint interactive 1  ;# else tcltest ends the process where there is Tk, with status 0
    ::tcltest::cleanupTests
    exit $failed
}

write_pqr straight.pqr 0
write_pqr bent.pqr 1.0
write_map weak.dx 0.5
write_map strong.dx -1.0
