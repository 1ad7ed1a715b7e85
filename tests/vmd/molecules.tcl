# molecules.tcl: molecules and maps that VMD holds give the command line's numbers; what is misused says what to do.
source [file join $env(ESPDIFF_TESTS) support.tcl]
package require espdiff

# Some numbers of OUT.json by key.
proc json_numbers {path keys} {
    set channel [open $path]
    set text [read $channel]
    close $channel
    set numbers {}
    foreach key $keys {
        if {![regexp "\"$key\": (\[-0-9.e+\]+)" $text -> number]} { error "$path has no number $key" }
        dict set numbers $key $number
    }
    return $numbers
}

set keys {rmsd_A mean_abs_difference rms_difference mean_signed_difference sign_change_area_fraction hodgkin_index
    mean_displacement_A}

proc load_with_map {structure type map} {
    set mol [mol new $structure type $type waitfor all]
    mol addfile $map type dx waitfor all $mol
    return $mol
}

test "TIM and its mutant, with maps: the command line's numbers to 1e-5" {
    set names {scTIM_chainA dTIM_chainA}
    foreach name $names side {source target} {
        set structure($side) [input pair_tim_maps/$name.pqr]
        set map($side) [input pair_tim_maps/${name}_pot-PE0.dx]
        set $side [load_with_map $structure($side) pqr $map($side)]
    }
    exec $env(ESPDIFF) compare $structure(source) $structure(target) --source-map $map(source) \
        --target-map $map(target) -q -o $scratch/tim
    set expected [json_numbers $scratch/tim.json $keys]
    set comparison [espdiff compare [list mol $source map 0 sel all] [list mol $target map 0 sel all]]
    foreach key $keys {
        # Gains and losses cancel in the signed mean: it is as exact as the absolute one.
        set scale [dict get $expected [expr {$key eq "mean_signed_difference" ? "mean_abs_difference" : $key}]]
        check "$key to 1e-5" {abs([espdiff result $comparison $key] - [dict get $expected $key]) <= 1e-5 * abs($scale)}
    }
    check_equal "radii" [espdiff result $comparison radii_origin source] file
    check_equal "unit" [espdiff result $comparison potential_unit] kT/e
    check "provenance" {[string match "*scTIM_chainA.pqr*frame 0*" [espdiff result $comparison inputs]]}

    # The same from files, in VMD: the same bits as the command line.
    set files [espdiff compare [list file $structure(source) map $map(source)] \
        [list file $structure(target) map $map(target)]]
    foreach key $keys { check_close "$key from files" [espdiff result $files $key] [dict get $expected $key] 1e-14 }
    espdiff delete all
    mol delete all
}

test "the selection, the frame and the radii are honoured" {
    set mol [mol new [input traj_adk/adk.psf] type psf waitfor all]
    mol addfile [input traj_adk/adk_dims.dcd] type dcd waitfor all $mol
    set core [list mol $mol frame 0 sel "resid 1 to 110"]
    set comparison [espdiff compare $core [list mol $mol frame 20 sel "resid 1 to 110"]]
    set atoms [atomselect $mol "resid 1 to 110"]
    check_equal "paired atoms" [espdiff result $comparison n_paired_atoms] [$atoms num]
    set first [atomselect $mol "resid 1 to 110" frame 0]
    set later [atomselect $mol "resid 1 to 110" frame 20]
    $later move [measure fit $later $first]
    check_close "RMSD as VMD finds it" [espdiff result $comparison rmsd_A] [measure rmsd $later $first] 1e-4
    check_equal "radii are VMD's guess" [espdiff result $comparison radii_origin target] vmd
    set plain [espdiff surface [concat $core {radii vmd}]]
    set element [espdiff surface [concat $core {radii element}]]
    check "Bondi's radii give another area" {[espdiff result $plain area_A2] != [espdiff result $element area_A2]}
    $atoms set radius 2.0
    set wide [espdiff surface $core]
    check "the user's radii count" {[espdiff result $wide area_A2] != [espdiff result $plain area_A2]}
    espdiff delete all
    mol delete all
}

test "what is misused is refused with what to do" {
    check_refused {espdiff compare {mol 77} {mol 77}} {ESPDIFF INPUT} "there is no molecule '77'" "mol new"
    set mol [mol new [input ubq/ubq.pdb] type pdb waitfor all]
    set ok [list mol $mol]
    check_refused {espdiff compare [list mol $mol frame 5] $ok} {ESPDIFF INPUT} "frame 5" "0 to 0"
    check_refused {espdiff compare [list mol $mol frame soon] $ok} {ESPDIFF INPUT} "all, first, now, last (or end), a number from 0"
    check_refused {espdiff compare [list mol $mol sel "resname XYZ"] $ok} {ESPDIFF INPUT} "holds no atoms"
    check_refused {espdiff compare [list mol $mol sel "resid and ("] $ok} {ESPDIFF INPUT} "not understood"
    check_refused {espdiff compare [list mol $mol map 0] $ok} {ESPDIFF INPUT} "map"
    check_refused {espdiff compare [list mol $mol map pme] $ok} {ESPDIFF INPUT} "have no charges" "PSF, PQR"
    check_refused {espdiff compare [list mol $mol colour 1] $ok} {ESPDIFF INPUT} "colour"
    set empty [mol new]
    check_refused {espdiff compare [list mol $empty] $ok} {ESPDIFF INPUT} "no atoms"
    set topology [mol new [input ubq/ubq.psf] type psf waitfor all]
    check_refused {espdiff compare [list mol $topology] $ok} {ESPDIFF INPUT} "no frames" "mol addfile"
    mol addfile [input ubq/ubq.pdb] type pdb waitfor all $topology
    set all [atomselect $mol all]
    $all set radius 0
    check_refused {espdiff compare $ok $ok} {ESPDIFF INPUT} "every radius is 0"
    check_equal "no handle is left over" [espdiff handles] {}
    mol delete all
}

test "a molecule that is deleted while it is used does not matter" {
    set mol [mol new [input ref_apbs/1tca.pqr] type pqr waitfor all]
    set running [espdiff compare [list mol $mol] [list mol $mol] -command list]
    mol delete $mol
    check_equal "finished" [espdiff wait $running] 1
    check "result" {[espdiff result $running rmsd_A] < 1e-6}
    check_refused {espdiff compare [list mol $mol] [list mol $mol]} {ESPDIFF INPUT} "there is no molecule"
    espdiff delete all
}

finish
