# doctor.tcl: lists what is available and what is missing, with the remedy.

namespace eval ::espdiff {
    # Items {name ok|missing|note text}.
    proc doctor_items {} {
        set items {}
        lappend items [list espdiff ok "[core::version], module [module_path]"]
        lappend items [list Tcl ok [info patchlevel]]
        lappend items {*}[doctor_build] {*}[doctor_viewer] {*}[doctor_temporary]
        if {![in_vmd]} {
            return [lappend items {VMD note "not running in VMD; {file PATH} endpoints work, {mol ID} ones need VMD"}]
        }
        return [concat $items [doctor_vmd] [doctor_window] [doctor_molecules]]
    }

    proc doctor_build {} {
        set items {}
        foreach back_end [core::back_ends] {
            set state [expr {[dict get $back_end available] ? "ok" : "note"}]
            lappend items [list "back end [dict get $back_end name]" $state [dict get $back_end description]]
            foreach gpu [dict get $back_end devices] {
                if {[llength [dict get $back_end devices]] < 2} continue
                set state [expr {[dict get $gpu available] ? "ok" : "note"}]
                lappend items [list [dict get $gpu name] $state [dict get $gpu description]]
            }
            if {![dict get $back_end available]} continue
            set state [expr {[dict get $back_end fourier available] ? "ok" : "missing"}]
            lappend items [list "PME on [dict get $back_end name]" $state [dict get $back_end fourier description]]
        }
        set build [core::build]
        foreach {part what} {gemmi "PDB and mmCIF files" HDF5 ensembles} {
            if {[dict get $build [string tolower $part]]} { lappend items [list $what ok "by $part"]; continue }
            lappend items [list $what missing "this build has no $part; install its development package, and build\
                again"]
        }
        set pdb2pqr [dict get $build pdb2pqr]
        lappend items [expr {$pdb2pqr ne "" ? [list PDB2PQR ok $pdb2pqr] : [list PDB2PQR missing "structures without\
            charges cannot get a potential; [dict get $build pdb2pqr_remedy]"]}]
        set ligands [dict get $build ligands]
        lappend items [list ligands [expr {[dict get $ligands available] ? "ok" : "missing"}]\
            [dict get $ligands description]]
        set gnuplot [lindex [auto_execok gnuplot] 0]
        lappend items [expr {$gnuplot ne "" ? [list gnuplot ok $gnuplot] : [list gnuplot missing "plots and maps cannot be\
            saved as pictures; install it (Debian: gnuplot-nox)"]}]
        return $items
    }

    proc doctor_viewer {} {
        set program [program_path]
        if {$program eq ""} {
            return {{viewer missing "the program espdiff is not beside the package nor on PATH; `espdiff view` needs\
                it"}}
        }
        if {![dict get [core::build] vtk]} {
            return {{viewer missing "this build has no VTK; install its development package, and build again"}}
        }
        return [list [list viewer ok $program]]
    }

    proc doctor_temporary {} {
        if {[catch { temporary_file .txt } path error]} { return [list [list "temporary files" missing $path]] }
        file delete $path
        return [list [list "temporary files" ok "in [file dirname $path]"]]
    }

    proc doctor_vmd {} {
        set items [list [list VMD ok "[vmdinfo version], [vmdinfo arch]"]]
        set abi [core::abi]
        if {[dict get $abi in_vmd]} {
            lappend items [list "maps through memory" ok "VMD's plugin interface [dict get $abi abi]"]
        } else {
            lappend items [list "maps through memory" missing "VMD took none of the plugin interfaces\
                [join [dict get $abi offered] {, }]; maps go through DX files, which is slower and keeps 6 digits"]
        }
        lappend items {"mol new FILE.vti" ok "reads VTI files"}
        return $items
    }

    proc doctor_window {} {
        if {![info exists ::tk_version]} {
            return {{window missing "no Tk here: VMD runs without its graphics window; all commands but gui work"}}
        }
        set items [list [list window ok "Tk $::tk_version"]]
        if {"espdiff" in [menu list]} {
            return [lappend items {"menu entry" ok "Extensions > Analysis > Surface Potential Comparison"}]
        }
        variable directory
        return [lappend items [list "menu entry" missing "add to .vmdrc (Windows: vmd.rc):\
            lappend auto_path {[file dirname $directory]};\
            vmd_install_extension espdiff espdiff_tk \"Analysis/Surface Potential Comparison\""]]
    }

    proc doctor_molecules {} {
        set items {}
        foreach mol [molinfo list] {
            set n [molinfo $mol get numatoms]
            set n_maps [molinfo $mol get numvolumedata]
            if {$n == 0 && $n_maps == 0} continue
            set text "$n atoms, [molinfo $mol get numframes] frames, $n_maps maps"
            if {$n > 0} { append text ", [doctor_atoms $mol]" }
            lappend items [list "molecule $mol ([molinfo $mol get name])" ok $text]
        }
        if {[llength $items] == 0} { lappend items {molecules note "none is loaded; `mol new FILE` loads one"} }
        return $items
    }

    proc doctor_atoms {mol} {
        set selection [atomselect $mol all]
        finally { set charges [$selection get charge] } { $selection delete }
        set charged [llength [lsearch -all -inline -not -exact $charges 0.0]]
        set radii [expr {[vmd_radii_origin $mol] eq "file" ? "radii from its file" : "radii guessed by VMD"}]
        if {$charged == 0} { return "$radii, no charges (PSF, PQR and prmtop files have them)" }
        return "$radii, charges on $charged atoms"
    }

    # `espdiff device`: an absent device is reported at once.
    proc device {options {name {}}} {
        variable default_device
        if {$name eq ""} { return $default_device }
        core::device $name
        return [set default_device $name]
    }

    proc doctor {options} {
        set lines {}
        set missing 0
        foreach item [doctor_items] {
            lassign $item name state text
            if {$state eq "missing"} { incr missing }
            lappend lines [format "%-8s %-24s %s" $state $name $text]
        }
        lappend lines "" [expr {$missing == 0 ? "Nothing is missing." : "Missing: $missing."}]
        return [join $lines \n]
    }
}
