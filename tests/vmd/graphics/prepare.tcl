# prepare.tcl: a molecule of VMD without charges gets some: by command, and by the window's button from VMD's menu.
source [file join $env(ESPDIFF_TESTS) support.tcl]
unset env(ESPDIFF_PDB2PQR)
package require espdiff

proc widget {name} { return $::espdiff::gui::widget($name) }
proc pause {ms} { after $ms {set ::tick 1}; vwait ::tick }
proc wait_until {condition} {
    set end [expr {[clock seconds] + 120}]
    while {![uplevel #0 [list expr $condition]]} {
        if {[clock seconds] > $end} { error "'$condition' did not come true" }
        pause 30
    }
}
proc message_line {} { string trim [[widget message] get 1.0 end] }
proc charge_of {mol} {
    set atoms [atomselect $mol all]
    set sum 0
    foreach charge [$atoms get charge] { set sum [expr {$sum + $charge}] }
    $atoms delete
    return $sum
}

set background {}
proc background_error {message options} { lappend ::background $message }
interp bgerror {} background_error

if {[string match "*prepare        --*" [exec $env(ESPDIFF) doctor]]} {
    note "SKIPPED: no PDB2PQR on PATH"
    finish
}
set source [mol new [input t4l/3lzm_from_bcif.pdb] type pdb waitfor all]
set target [mol new [input t4l/181L.pdb] type pdb waitfor all]

test "by command: hydrogens, charges and radii of a selection" {
    set handle [espdiff prepare [list mol $source sel protein] -pqr $scratch/source.pqr]
    set result [espdiff result $handle]
    check "hydrogens" {[dict get $result preparation n_hydrogens_added] > 1300}
    set mol [mol new [dict get $result file] type pqr waitfor all]
    check_equal "residues" [llength [lsort -unique [[atomselect $mol "name CA"] get resid]]] 164
    check_close "net charge" [charge_of $mol] [dict get $result preparation net_charge] 1e-4
    mol delete $mol
    espdiff delete $handle
}

test "refused: no charges for the ligand, no map, no such file" {
    check_refused {espdiff prepare [list mol $target sel "not water"] -ligands files -pqr $scratch/no.pqr} {ESPDIFF INPUT} \
        "get no charges from PDB2PQR" "-leave-out (BNZ,HED)"
    check "no file" {![file exists $scratch/no.pqr]}
    check_refused {espdiff prepare [list mol $target map pb] -pqr $scratch/no.pqr} {ESPDIFF INPUT} "is not of a preparation"
    set definition [file join $env(ESPDIFF_TESTS) .. fuzz seeds component dictionary.cif]
    check_refused {espdiff prepare [list mol $target sel "not water"] -ligand $definition -pqr $scratch/no.pqr} \
        {ESPDIFF INPUT} "no residue that is prepared" "of one of its components"
    check_refused {espdiff prepare [list mol $target sel "not water"] -leave-out (BNZ) -pqr $scratch/no.pqr} {ESPDIFF INPUT} \
        "choose its atoms by `sel`"
    check_refused {espdiff compare [list mol $source map pb] [list mol $target map pb]} {ESPDIFF INPUT} \
        "have no charges" "`espdiff prepare` makes some"
    check_refused {espdiff compare [list mol $source map none] [list mol $target map none] -select //A} {ESPDIFF INPUT} \
        "choose its atoms by `sel`"
}

test "the window offers it, and says why" {
    vmd_install_extension espdiff espdiff_tk "Analysis/Surface Potential Comparison"
    menu espdiff on
    update
    set ::espdiff::gui::form(target,sel) protein
    set ::espdiff::gui::form(source,sel) protein
    foreach side {source target} { ::espdiff::gui::update_endpoint $side }
    update
    check "the row is there" {[winfo ismapped [widget source,charges]]}
    check_equal "why" [[widget source,charges_text] cget -text] "No charges in PDB"
    if {[info exists env(ESPDIFF_KEEP)]} {
        pause 500
        exec import -window root $scratch/prepare_before.png
    }
}

test "Compare offers it for both sides: two clicks from the structures to the picture" {
    foreach side {source target} {
        set path [::espdiff::gui::prepared_path $side]
        check_equal "in the working folder: $path" [file dirname $path] [pwd]
        check "a new name" {[string match "*-prepared*.pqr" $path] && ![file exists $path]}
    }
    # Nothing of this test stays in the working folder.
    rename ::espdiff::gui::prepared_path ::prepared_beside
    proc ::espdiff::gui::prepared_path {side} { return $::scratch/$side-offered.pqr }
    set question ""
    rename tk_messageBox tk_box
    proc tk_messageBox {args} {
        set ::question [dict get $args -message]
        set ::detail [dict get $args -detail]
        return $::answer
    }
    array set ::espdiff::gui::setting {grid-spacing 2}
    set answer cancel
    [widget compare] invoke
    check_equal "asked by name" $question "No charges: $::espdiff::gui::form(source,mol) and $::espdiff::gui::form(target,mol)"
    check "the files are named: $detail" {[string match "*source-offered.pqr*target-offered.pqr*$scratch*" $detail]}
    check_equal "nothing runs" [list $::espdiff::gui::running [espdiff handles]] {{} {}}
    set answer yes
    set offered [array get ::espdiff::gui::form]
    [widget compare] invoke
    wait_until {$::espdiff::gui::running eq "" && !$::espdiff::gui::compares_next}
    rename tk_messageBox ""
    rename tk_box tk_messageBox
    rename ::espdiff::gui::prepared_path ""
    rename ::prepared_beside ::espdiff::gui::prepared_path
    set comparison $::espdiff::gui::shown
    check "charged: [message_line]" {[string match "Poisson-Boltzmann*" [espdiff result $comparison potential label]]}
    check "drawn" {[llength [::espdiff::drawing_of $comparison]] > 1}
    check_equal "the structures are hidden" [list [molinfo $source get displayed] [molinfo $target get displayed]] {0 0}
    check "the script" {[string match "*espdiff*prepare*source-offered.pqr*" [::espdiff::gui::session_text]]}
    espdiff delete all
    foreach mol [lrange [molinfo list] 2 end] { mol delete $mol }
    array set ::espdiff::gui::form $offered
    foreach side {source target} { ::espdiff::gui::update_endpoint $side }
    update
}

test "shapes alone: each side names its own molecule" {
    foreach {side name} {source 3lzm_from_bcif.pdb target 181L.pdb} {
        check_equal $side [[widget $side,choice] cget -text] "Shapes alone: $name has no charges"
    }
}

# The dialog cannot be used by a script; the file's name is all it gives.
proc tk_getSaveFile {args} { return $::scratch/[dict get $args -initialfile] }

test "pressed: prepared in the background, loaded beside, chosen" {
    foreach side {source target} {
        set before [molinfo num]
        [widget $side,prepare] invoke
        check "in the background" {$::espdiff::gui::preparing ne ""}
        wait_until {$::espdiff::gui::running eq ""}
        check_equal "one more molecule" [molinfo num] [expr {$before + 1}]
        check "its words" {[string match "PDB2PQR v3*hydrogens added*" [message_line]]}
        check "it is chosen" {[string match "*prepared.pqr" $::espdiff::gui::form($side,mol)]}
        update
        check "no offer any more" {![winfo ismapped [widget $side,charges]]}
    }
    if {[info exists env(ESPDIFF_KEEP)]} {
        pause 500
        exec import -window root $scratch/prepare_after.png
    }
}

test "the prepared pair is compared in salt water, with a region, and the script says how it was made" {
    array set ::espdiff::gui::setting {grid-spacing 2 region //A/99}
    [widget compare] invoke
    wait_until {$::espdiff::gui::running eq ""}
    set comparison $::espdiff::gui::shown
    check "potential" {[string match "Poisson-Boltzmann*" [espdiff result $comparison potential label]]}
    check_equal "region" [espdiff result $comparison region n_residues] 1
    check "the script" {[string match "*espdiff*prepare*-pqr*" [::espdiff::gui::session_text]]}
}

test "a region in VMD's words" {
    set mols [lrange [molinfo list] end-1 end]
    set handle [espdiff compare [list mol [lindex $mols 0] map none region "within 5 of resid 99"] \
        [list mol [lindex $mols 1] map none] -grid-spacing 2]
    check "residues" {[espdiff result $handle region n_residues] > 3}
    set patched [espdiff compare [list mol [lindex $mols 0] map none] [list mol [lindex $mols 1] map none] -grid-spacing 2 \
        -patch {site //*/99 rest //*/1-98}]
    check_equal "patches of molecules" [dict keys [espdiff result $patched fixed_patches]] {site rest}
    check_equal "one residue" [espdiff result $patched fixed_patches site n_residues] 1
    check_refused {espdiff compare [list mol [lindex $mols 0] map none region "resid 9999"] \
        [list mol [lindex $mols 1] map none]} {ESPDIFF INPUT} "holds no atoms"
    espdiff trajectory -mol [lindex $mols 1] -sel all -map none -frames last -csv $scratch/region.csv -grid-spacing 2 \
        -reference [list mol [lindex $mols 0] map none region "within 5 of resid 99"]
    set row [lindex [dict get [::espdiff::core::read_csv $scratch/region.csv] rows] 0]
    check_close "the same in a trajectory" [dict get $row region_mean_displacement_A] \
        [espdiff result $handle region mean_displacement_A] 1e-9
    espdiff delete $handle
}

if {[auto_execok obabel] eq ""} {
    note "SKIPPED: ligands: no Open Babel on PATH"
} else {
    proc prepare_with {ligand} {
        array set ::espdiff::gui::form [list source,kind mol source,sel "protein or resname $ligand" \
            source,mol "$::target: [molinfo $::target get name]"]
        ::espdiff::gui::update_endpoint source
        update
        [widget source,prepare] invoke
        wait_until {$::espdiff::gui::running eq ""}
        update
    }
    # Off the grid of 0.001 A, as frames of a trajectory are.
    set all [atomselect $target all]
    $all moveby [list [expr {1.0 / 3}] [expr {1.0 / 7}] 0]

    test "a ligand's hydrogens and coordinates of many digits: VMD reads what was prepared" {
        set before [molinfo num]
        prepare_with BNZ
        check_equal "loaded: [message_line]" [molinfo num] [expr {$before + 1}]
        set mol [lindex [molinfo list] end]
        set hydrogens [atomselect $mol "resname BNZ and name \"H.*\""]
        check_equal "hydrogens" [$hydrogens num] 6
        set given [atomselect $target "protein or resname BNZ"]
        set prepared [atomselect $mol "not name \"H.*\""]
        check_equal "the same chain" [lsort -unique [$prepared get chain]] A
        foreach ours [concat {*}[measure minmax $prepared]] theirs [concat {*}[measure minmax $given]] {
            check_close "the same place" $ours $theirs 1e-3
        }
        foreach selection [list $hydrogens $given $prepared] { $selection delete }
        mol delete $mol
    }

    test "names that VMD cannot read: the file takes the molecule's place" {
        set benzene [atomselect $target "resname BNZ"]
        $benzene set resname BENZ
        set before [molinfo num]
        prepare_with BENZ
        check_equal "not loaded" [molinfo num] $before
        check "said: [message_line]" {[string match "*the file is chosen instead of a molecule" [message_line]]}
        check_equal "a file" $::espdiff::gui::form(source,kind) file
        check "there" {[file exists $::espdiff::gui::form(source,file)]}
        check "it is shown" {[winfo ismapped [widget source,browse_map]] && ![winfo ismapped [widget source,charges]]}
        array set ::espdiff::gui::setting {grid-spacing 2 region {}}
        [widget compare] invoke
        wait_until {$::espdiff::gui::running eq ""}
        set comparison $::espdiff::gui::shown
        check "compared: [message_line]" {[string match "Poisson-Boltzmann*" [espdiff result $comparison potential label]]}
        check "the script" {[string match "*espdiff*prepare*-pqr*" [::espdiff::gui::session_text]]}
        $benzene set resname BNZ
        $benzene delete
    }
    $all delete
}

test "no callback failed" { check_equal errors $background {} }

espdiff delete all
finish
