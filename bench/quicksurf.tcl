# quicksurf.tcl: times VMD's QuickSurf on the atoms of "x y z radius" files, as a peer for density and isosurface.
#
# vmd -dispdev text -e quicksurf.tcl -args OUT.csv ATOMS...
# Grid 1 A, radius scale 1, isovalue 0.5; qualities 0 to 3, which cut the Gaussians off at 2, 2.5, 3 and 4 widths (espdiff: 4.5).
# VMDFORCECPUCOUNT=1 keeps it to one thread. The isovalue changes by a hair from run to run, else VMD would not compute again.

proc load_atoms {path} {
    set channel [open $path]
    set rows [split [string trim [read $channel]] "\n"]
    close $channel
    set molecule [mol new atoms [llength $rows]]
    animate dup $molecule
    set all [atomselect $molecule all]
    $all set {x y z radius} [lmap row $rows {lrange $row 0 3}]
    $all delete
    return $molecule
}

# Milliseconds, and triangles, of one quality: the median of many runs after three to warm up.
proc measure {molecule quality runs} {
    set times {}
    for {set i 0} {$i < $runs + 3} {incr i} {
        mol modstyle 0 $molecule QuickSurf 1.0 [expr {0.5 + 1e-6 * $i}] 1.0 $quality
        set microseconds [lindex [time {display update}] 0]
        if {$i >= 3} {lappend times $microseconds}
    }
    return [format %.3f [expr {[lindex [lsort -real $times] [expr {$runs / 2}]] / 1000.0}]]
}

# VMD does not tell how many triangles it drew; the scene it writes as STL does.
proc count_triangles {scene} {
    render STL $scene
    set channel [open $scene]
    set n [regexp -all {facet normal} [read $channel]]
    close $channel
    file delete $scene
    return $n
}

set out [open [lindex $argv 0] w]
puts $out "atoms,n_atoms,quality,ms,triangles"
foreach path [lrange $argv 1 end] {
    set molecule [load_atoms $path]
    set n_atoms [molinfo $molecule get numatoms]
    mol delrep 0 $molecule
    mol color ColorID 0
    mol representation QuickSurf 1.0 0.5 1.0 0
    mol addrep $molecule
    foreach quality {0 1 2 3} {
        set ms [measure $molecule $quality [expr {$n_atoms > 30000 ? 9 : 25}]]
        puts $out "[file rootname [file tail $path]],$n_atoms,$quality,$ms,[count_triangles [lindex $argv 0].stl]"
    }
    mol delete $molecule
}
close $out
quit
