# volumes.tcl: maps go out of VMD and into it through memory, value by value, and through DX files where that is closed.
source [file join $env(ESPDIFF_TESTS) support.tcl]
package require espdiff

test "a map of VMD arrives in memory with its lattice" {
    set mol [mol new [input pair_tim_maps/scTIM_chainA_pot-PE0.dx] type dx waitfor all]
    animate write espdiffvolume from-vmd beg 0 end 0 volsets {0} $mol
    set map [::espdiff::core::describe_volume from-vmd]
    set channel [open [input pair_tim_maps/scTIM_chainA_pot-PE0.dx]]
    while {[gets $channel line] >= 0 && ![regexp {counts ([0-9]+) ([0-9]+) ([0-9]+)} $line -> nx ny nz]} {}
    while {[gets $channel line] >= 0 && ![regexp {origin (\S+) (\S+) (\S+)} $line -> x y z]} {}
    while {[gets $channel line] >= 0 && ![regexp {delta (\S+)} $line -> delta]} {}
    close $channel
    check_equal "size" [dict get $map size] [list $nx $ny $nz]
    foreach found [dict get $map origin] expected [list $x $y $z] { check_close origin $found $expected 1e-6 }
    check_close spacing [lindex [dict get $map step] 0 0] $delta 1e-5
    ::espdiff::core::forget_volume from-vmd
    mol delete all
}

test "memory and DX files give the same comparison" {
    foreach {name side} {scTIM_chainA source dTIM_chainA target} {
        set $side [mol new [input pair_tim_maps/$name.pqr] type pqr waitfor all]
        mol addfile [input pair_tim_maps/${name}_pot-PE0.dx] type dx waitfor all [set $side]
    }
    set memory [espdiff compare [list mol $source map 0] [list mol $target map 0]]
    # As in a VMD that does not take the file types.
    rename ::espdiff::core::abi ::espdiff::core::real_abi
    proc ::espdiff::core::abi {} { dict replace [real_abi] in_vmd 0 abi {} }
    ::espdiff::finally {
        set files [espdiff compare [list mol $source map 0 unit kT/e] [list mol $target map 0 unit kT/e]]
    } {
        rename ::espdiff::core::abi {}
        rename ::espdiff::core::real_abi ::espdiff::core::abi
    }
    foreach key {mean_abs_difference rms_difference hodgkin_index} {
        check_close $key [espdiff result $files $key] [espdiff result $memory $key] 1e-5
    }
    check_equal "nothing is left in memory" [::espdiff::core::volumes] {}
}

test "the difference becomes a data set of the molecule, found at its atoms, and view and top stay" {
    mol top $source
    set views {}
    foreach mol [molinfo list] { lappend views [molinfo $mol get {center_matrix rotate_matrix scale_matrix global_matrix}] }
    set index [espdiff map $memory -mol $target -quantity difference]
    check_equal "number of the data set" $index 1
    check_equal "data sets" [molinfo $target get numvolumedata] 2
    check_equal "top" [molinfo top] $source
    set now {}
    foreach mol [molinfo list] { lappend now [molinfo $mol get {center_matrix rotate_matrix scale_matrix global_matrix}] }
    check_equal "views" $now $views
    # Inside the range of the surface's values, and not zero near it.
    set surface [atomselect $target "resid 70 to 90 and sidechain"]
    set values [$surface get interpvol$index]
    set range [::espdiff::core::range $memory difference]
    foreach value $values {
        check "value $value" {$value >= [dict get $range min] - 1e-4 && $value <= [dict get $range max] + 1e-4}
    }
    check "not all zero" {[llength [lsearch -all -not -real $values 0.0]] > 0}
}

test "a representation can be coloured by it" {
    mol representation QuickSurf
    mol color Volume 1
    mol addrep $target
    check "colour" {[string match "Volume 1*" [lindex [molinfo $target get {{color 1}}] 0]]}
}

test "a VTI file is a molecule for VMD" {
    set mol [mol new [input map_vti/hydrogen.vti] type vti waitfor all]
    check_equal "data sets" [molinfo $mol get numvolumedata] 1
    animate write espdiffvolume vti beg 0 end 0 volsets {0} $mol
    check_equal "size" [dict get [::espdiff::core::describe_volume vti] size] {64 64 64}
    ::espdiff::core::forget_volume vti
    set bare [mol new [input map_vti/hydrogen.vti] waitfor all]
    check_equal "by its name alone" [molinfo $bare get numvolumedata] 1
}

test "a damaged VTI file is refused, and VMD lives" {
    set channel [open $scratch/damaged.vti w]
    puts $channel {<?xml version="1.0"?><VTKFile type="ImageData"><ImageData WholeExtent="0 3 0 3 0 3">}
    close $channel
    check "refused" {[catch {mol new $scratch/damaged.vti type vti waitfor all}]}
}

test "a data set that does not exist is refused with those that do" {
    check_refused {espdiff compare [list mol $source map 9] [list mol $target map 0]} {ESPDIFF INPUT} "9"
    check_refused {espdiff map $memory} {ESPDIFF INPUT} "-mol" "-file"
    check_refused {espdiff map $memory -mol 123} {ESPDIFF INPUT} "there is no molecule '123'"
}

finish
