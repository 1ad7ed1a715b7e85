# pmepot.tcl: times VMD's PMEPot as a peer for bench/pme.cpp: its core on as many random charges and points, and the whole
# command beside ours on a loaded molecule.
#
# VMDPLUGINPATH=BUILD/vmd vmd -dispdev text -e pmepot.tcl -args OUT.csv
# The core's time includes that Tcl lists become arrays; the same call on a grid of 8^3 shows that part (and the spreading).

package require pmepot

proc random_atoms {n edge} {
    expr {srand(7)}
    set atoms {}
    for {set i 0} {$i < $n} {incr i} {
        lappend atoms [list [expr {$edge * (rand() - 0.5)}] [expr {$edge * (rand() - 0.5)}] [expr {$edge * (rand() - 0.5)}] [expr {rand() - 0.5}]]
    }
    return $atoms
}

proc median_ms {runs script} {
    set times {}
    for {set i 0} {$i < $runs} {incr i} { lappend times [lindex [time {uplevel 1 $script}] 0] }
    return [format %.2f [expr {[lindex [lsort -real $times] [expr {$runs / 2}]] / 1000.0}]]
}

# Each map begins afresh, as the first frame of a run does.
proc core_ms {atoms edge points runs} {
    set cell [list {0 0 0} [list $edge 0 0] [list 0 $edge 0] [list 0 0 $edge]]
    return [median_ms $runs {
        set handle [pmepot_create [list $points $points $points] 0.25]
        pmepot_add $handle $cell $atoms
        pmepot_destroy $handle
    }]
}

# Whole commands, from atoms in VMD to the map in VMD, one after the other in each round, so that what else the machine
# does slows all down alike: PMEPot, and where our module is found espdiff on one thread. A dict of medians.
proc command_ms {atoms edge points runs} {
    set molecule [mol new atoms [llength $atoms]]
    animate dup $molecule
    set all [atomselect $molecule all]
    $all set {x y z charge} $atoms
    $all delete
    set cell [list {0 0 0} [list $edge 0 0] [list 0 $edge 0] [list 0 0 $edge]]
    set same [list -mol $molecule -cell $cell -grid $points -loadmol new]
    set commands [dict create pmepot [list pmepot {*}$same]]
    if {![catch { package require espdiff }]} {
        dict set commands espdiff_compatible [list espdiff potential {*}$same -compatible 1 -threads 1]
        dict set commands espdiff_order_6 [list espdiff potential {*}$same -threads 1]
    }
    set times {}
    for {set i -1} {$i < $runs} {incr i} {
        dict for {name command} $commands {
            set before [molinfo list]
            set ms [expr {[lindex [time $command] 0] / 1000.0}]
            foreach map [molinfo list] { if {$map ni $before} { mol delete $map } }
            if {$i >= 0} { dict lappend times $name $ms }
        }
    }
    mol delete $molecule
    set medians {}
    dict for {name values} $times { lappend medians $name [format %.2f [lindex [lsort -real $values] [expr {$runs / 2}]]] }
    return $medians
}

set out [open [lindex $argv 0] w]
puts $out "case,atoms,grid,what,ms"
foreach {name n edge points runs} {5k 5000 80 80 15 50k 50000 80 80 15 23k 23558 62.23 64 15} {
    set atoms [random_atoms $n $edge]
    core_ms $atoms $edge 8 2
    puts $out "$name,$n,$points,core,[core_ms $atoms $edge $points $runs]"
    puts $out "$name,$n,8,core,[core_ms $atoms $edge 8 $runs]"
    dict for {what ms} [command_ms $atoms $edge $points 11] { puts $out "$name,$n,$points,command $what,$ms" }
}
close $out
quit
