# vmd_molecule.tcl: atoms, coordinates, radii and charges of a molecule that VMD holds, for the core.

namespace eval ::espdiff {
    # File types of VMD that carry radii of their own; all others leave VMD's guess by element or name, and those that
    # set that guess again when they are added to a molecule are in the second list.
    variable types_with_radii {pqr js vsf vtf hoomd lammpstrj}
    variable types_that_guess_radii {pdb webpdb pdbx xyz cube gaussian cpmdlog xsf}
    # File types that carry charges. Gaussian cube files are not among them: their "charges" are the nuclei's.
    variable types_with_charges {
        psf pqr parm parm7 tpr mol2 js mae dms bgf xbgf car mdf pdbx vsf vtf hoomd lammpstrj gaussian gamess cpmdlog
    }

    proc require_vmd {what {remedy "outside of it give files: {file PATH ?map PATH?}"}} {
        if {![in_vmd]} { fail "$what needs VMD; $remedy" }
    }

    # The id of a molecule that exists; `top` counts.
    proc vmd_molecule_id {mol role} {
        require_vmd "$role: a molecule of VMD"
        if {$mol eq "top" && [molinfo num] > 0} { set mol [molinfo top] }
        if {[string is integer -strict $mol] && $mol in [molinfo list]} { return $mol }
        set loaded {}
        foreach id [molinfo list] {
            # Drawings are molecules too.
            if {[molinfo $id get numatoms] + [molinfo $id get numvolumedata] == 0} continue
            lappend loaded "$id ([molinfo $id get name])"
        }
        if {[llength $loaded] == 0} {
            fail "$role: there is no molecule '$mol'; none is loaded, `mol new FILE` loads one"
        }
        fail "$role: there is no molecule '$mol'; loaded are [join_words $loaded and]"
    }

    # What is written of frames as a list of numbers; `what` is the option, for messages.
    proc vmd_frames {mol text what} {
        set n [molinfo $mol get numframes]
        set name "molecule $mol ([molinfo $mol get name])"
        if {$n == 0} { fail "$what: $name has no frames; `mol addfile FILE waitfor all $mol` adds coordinates" }
        return [core::frames $what $text $n [molinfo $mol get frame] $name]
    }

    # The same of one frame.
    proc vmd_frame {mol frame role} {
        set frames [vmd_frames $mol $frame "$role: frame"]
        if {[llength $frames] != 1} { fail "$role: frame '$frame': one frame is needed, not [llength $frames]" }
        return [lindex $frames 0]
    }

    # Numbers that VMD's atoms have, for fields of a comparison.
    variable vmd_fields {user user2 user3 user4 beta occupancy mass charge radius}

    # All of the core's endpoint but the coordinates, and under `mol`, `n_atoms` and `sel` where they are: one look at
    # the structure serves all frames. The selection is that of the endpoint's frame. `given` are the names of the
    # atoms' fields that come along.
    proc vmd_structure {endpoint role} {
        variable given_fields
        set mol [vmd_molecule_id [dict get $endpoint mol] $role]
        set name [molinfo $mol get name]
        set n_atoms [molinfo $mol get numatoms]
        if {$n_atoms == 0} {
            fail "$role: molecule $mol ($name) has no atoms; a structure file has to be loaded into it"
        }
        set frame [vmd_frame $mol [value_or $endpoint frame now] $role]
        set text [value_or $endpoint sel "not water"]
        set radii [value_or $endpoint radii vmd]
        if {$radii ni {vmd element}} { fail "$role: radii '$radii' is not vmd or element" }
        if {[catch { atomselect $mol $text frame $frame } selection]} {
            fail "$role: the selection '$text' of molecule $mol ($name) is not understood by VMD ($selection)"
        }
        finally {
            set atoms [$selection get {name resname resid insertion chain segname element radius charge}]
            set indices [$selection list]
        } { $selection delete }
        if {[llength $atoms] == 0} { fail "$role: the selection '$text' of molecule $mol ($name) holds no atoms" }
        set whole [value_or $endpoint whole 0]
        if {$whole ni {0 1}} { fail "$role: whole '$whole' is not 0 or 1" }
        return [dict create mol $mol n_atoms $n_atoms sel $text atoms $atoms indices $indices whole $whole \
            given [lsort -unique $given_fields] \
            radii_origin [expr {$radii eq "element" ? "element" : [vmd_radii_origin $mol]}] \
            charges_origin [vmd_charges_origin $mol $atoms]]
    }

    # The core's endpoint at a frame.
    proc vmd_with_frame {structure frame} {
        set mol [dict get $structure mol]
        set name [molinfo $mol get name]
        set n [molinfo $mol get numframes]
        if {$frame >= $n} { fail "molecule $mol ($name): frame $frame is not there any more; $n are left" }
        set coordinates [gettimestep $mol $frame]
        if {[string length $coordinates] != 12 * [dict get $structure n_atoms]} {
            fail "molecule $mol ($name): frame $frame has [expr {[string length $coordinates] / 12}] atoms instead of\
                [dict get $structure n_atoms]"
        }
        set endpoint [dict remove $structure mol n_atoms sel given]
        dict set endpoint coordinates $coordinates
        dict set endpoint name "$name, frame $frame"
        dict set endpoint input "mol $mol \"$name\" frame $frame sel \"[dict get $structure sel]\""
        dict set endpoint cell [molinfo $mol get {a b c alpha beta gamma} frame $frame]
        if {[llength [dict get $structure given]] > 0} {
            dict set endpoint values [vmd_values $mol $frame [dict get $structure given]]
        }
        return $endpoint
    }

    # Values of all atoms at a frame, {NAME LIST ...}: `user` and its like are of a frame, the others of the molecule.
    proc vmd_values {mol frame names} {
        set all [atomselect $mol all frame $frame]
        finally {
            set values {}
            foreach name $names {
                if {[catch { $all get $name } column]} {
                    fail "field $name: VMD's atoms have none of that name ($column); `atomselect keywords` lists them"
                }
                foreach value $column {
                    if {![string is double -strict $value]} {
                        fail "field $name: VMD's atoms have '$value' there, which is no number"
                    }
                }
                lappend values $name $column
            }
        } { $all delete }
        return $values
    }

    # The atoms of a region, as indices; VMD's selections know distances, such as
    # `same residue as protein within 5 of resname AP5`.
    proc vmd_region {mol text frame role} {
        set name "molecule $mol ([molinfo $mol get name])"
        if {$role ni {source reference}} { fail "$role: `region` belongs to the source" }
        if {[catch { atomselect $mol $text frame $frame } selection]} {
            fail "$role: the region '$text' of $name is not understood by VMD ($selection)"
        }
        finally { set atoms [$selection list] } { $selection delete }
        if {[llength $atoms] == 0} { fail "$role: the region '$text' of $name holds no atoms" }
        return $atoms
    }

    # The last file with radii counts: VMD lets it replace those of files before it.
    proc vmd_radii_origin {mol} {
        variable types_with_radii
        variable types_that_guess_radii
        set origin vmd
        foreach type [lindex [molinfo $mol get filetype] 0] {
            if {$type in $types_with_radii} { set origin file }
            if {$type in $types_that_guess_radii} { set origin vmd }
        }
        return $origin
    }

    # Charges that are all 0 are none: VMD has 0 where a file says nothing. Charges without a file that brings them were
    # set by the user (`$sel set charge`), and count.
    proc vmd_charges_origin {mol atoms} {
        foreach atom $atoms { if {[lindex $atom 8] != 0} { return file } }
        return none
    }

    proc vmd_require_charges {structure role} {
        variable types_with_charges
        if {[dict get $structure charges_origin] ne "none"} return
        set mol [dict get $structure mol]
        set types [lindex [molinfo $mol get filetype] 0]
        set why "none of its files ([join $types {, }]) carries charges"
        foreach type $types { if {$type in $types_with_charges} { set why "all charges in its files are 0" } }
        fail "$role: the atoms of molecule $mol ([molinfo $mol get name]) have no charges: $why; `espdiff prepare`\
            makes some, PSF, PQR and Amber prmtop files have some, `\$sel set charge` sets them"
    }
}
