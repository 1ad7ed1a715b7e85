# atoms.tcl: writes residues' quantities to the atoms of VMD's molecules, or to a PDB file.

namespace eval ::espdiff {
    proc atoms {options handle} {
        require_core_handle $handle
        set quantity [dict get $options quantity]
        if {$quantity eq "auto"} {
            set quantity [usual_metric [expr {[dict get [core::result $handle] potential_unit] ne ""}]]
        }
        if {[dict get $options file] ne ""} {
            return [core::residue_pdb $handle $quantity [dict get $options file] [dict get $options overwrite]]
        }
        require_vmd "espdiff atoms" "outside of it -file FILE writes a PDB file with the values as B factors"
        set mol [atoms_molecule $handle [dict get $options mol]]
        set values [residue_values $handle $quantity $mol]
        set carried [dict merge [dict create quantity $quantity unit [dict get $values unit] mol $mol \
            field [dict get $options field]] [set_atoms $mol [dict get $values of] $options]]
        if {[dict get $options show]} { show_atom_colors $handle $carried }
        return $carried
    }

    proc atoms_molecule {handle mol} {
        if {$mol ni {source target}} { return [vmd_molecule_id $mol -mol] }
        set id [molecule_of $handle $mol]
        if {$id eq ""} {
            fail "-mol: the $mol of $handle came from a file, or its molecule is deleted; name a molecule's id"
        }
        return $id
    }

    # Identifier of a residue that VMD and files share; VMD writes chain X if a file has no chains.
    proc residue_key {chain segment number insertion} {
        if {$chain in {X " " ""}} { set chain $segment }
        if {$chain eq "X"} { set chain "" }
        return "$chain|$number|[string trim $insertion]"
    }

    # The key of a row of `core::residues` in the source, or of its partner in the target; empty for no partner.
    proc key_on {side residue} {
        set prefix [expr {$side eq "target" ? "target_" : ""}]
        if {$side eq "target" && [dict get $residue target_name] eq ""} { return "" }
        residue_key [dict get $residue ${prefix}chain] "" [dict get $residue ${prefix}number] \
            [dict get $residue ${prefix}insertion]
    }

    # "A:TRP90", "A:TRP90->SER" where it is mutated, "A:TRP90->B:TRP91" where its partner has another chain or number.
    proc residue_name {row} {
        lassign [list [chain_prefix $row ""] [chain_prefix $row target_]] own other
        set name "[dict get $row name][dict get $row number][dict get $row insertion]"
        set partner [dict get $row target_name]
        if {$partner eq ""} { return $own$name }
        set number "[dict get $row target_number][dict get $row target_insertion]"
        if {$other eq $own} { set other "" }
        if {$other ne "" || $number ne "[dict get $row number][dict get $row insertion]"} {
            return "$own$name->$other$partner$number"
        }
        return $own$name[expr {$partner eq [dict get $row name] ? "" : "->$partner"}]
    }

    # VMD names a chain that the file does not name X.
    proc chain_prefix {row side} {
        set chain [dict get $row ${side}chain]
        expr {$chain in {"" X " "} ? "" : "$chain:"}
    }

    # Whose residues a molecule has: target, source, or both of them; those of the source for a molecule that was not
    # compared.
    proc sides_of {handle mol} {
        set sides {}
        foreach side {target source} { if {[molecule_of $handle $side] eq $mol} { lappend sides $side } }
        expr {$sides eq "" ? "source" : $sides}
    }

    # Values by the residue_key that the residues have in a molecule, only existing ones; and the unit.
    proc residue_values {handle quantity mol} {
        set values [core::residue_quantity $handle $quantity]
        set of [dict create]
        foreach side [sides_of $handle $mol] {
            foreach residue [core::residues $handle] value [dict get $values values] {
                set key [key_on $side $residue]
                if {$value ne "" && $key ne ""} { dict set of $key $value }
            }
        }
        return [dict create unit [dict get $values unit] of $of]
    }

    # Sets the field of every atom; returns the number of atoms with a value, and the range.
    proc set_atoms {mol of options} {
        set all [atomselect $mol all]
        finally {
            set column {}
            set found {}
            foreach atom [$all get {chain segname resid insertion}] {
                set key [residue_key {*}$atom]
                if {[dict exists $of $key]} {
                    lappend column [dict get $of $key]
                    lappend found [dict get $of $key]
                } else {
                    lappend column [dict get $options missing]
                }
            }
            if {[llength $found] == 0} {
                fail "espdiff atoms: no residue of molecule $mol ([molinfo $mol get name]) has the chain and number of\
                    one that was compared"
            }
            foreach frame [atoms_frames $mol $options] {
                $all frame $frame
                $all set [dict get $options field] $column
            }
        } { $all delete }
        set sorted [lsort -real $found]
        return [dict create atoms [llength $found] min [lindex $sorted 0] max [lindex $sorted end]]
    }

    proc atoms_frames {mol options} {
        set frame [dict get $options frame]
        if {$frame ne "all" || ![string match user* [dict get $options field]]} {
            return [vmd_frame $mol [expr {$frame eq "all" ? "now" : $frame}] -frame]
        }
        set frames {}
        for {set i 0} {$i < [molinfo $mol get numframes]} {incr i} { lappend frames $i }
        return $frames
    }
}
