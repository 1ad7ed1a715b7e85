# highlight.tcl: highlights residues of a result in VMD by removable representations.

namespace eval ::espdiff {
    variable highlights [dict create]  ;# by handle: {molecule name} of each representation

    proc highlight {options handle residues} {
        require_vmd "espdiff highlight" "outside of it `espdiff residues` has the numbers"
        require_core_handle $handle
        set rows [residue_rows $handle $residues]
        set atoms [dict create]
        foreach mol [highlighted_molecules $handle [dict get $options mol]] {
            dict set atoms $mol [atoms_of_residues $mol [residue_keys $handle $rows $mol]]
        }
        set found {}
        dict for {mol indices} $atoms { if {[llength $indices] > 0} { lappend found $mol } }
        if {[llength $residues] > 0 && [llength $found] == 0} {
            set names {}
            foreach row $rows { lappend names "[dict get $row chain]:[dict get $row name][dict get $row number]" }
            fail "espdiff highlight: no molecule has [join $names {, }] or its partner any more; its chains or numbers\
                have changed since the comparison, or the molecule given by [spelled mol] was not compared"
        }
        foreach mol $found { lappend visible [molinfo $mol get displayed] }
        if {$found ne "" && 1 ni $visible} {
            fail "espdiff highlight: [expr {[llength $found] == 1 ? "molecule [lindex $found 0] is" : "molecules\
                [join_words $found and] are"}] hidden, so that nothing would be seen; show one (`mol on\
                [lindex $found 0]`, or the D in VMD's list), then highlight again"
        }
        forget_highlight $handle
        variable highlights
        foreach mol $found {
            dict lappend highlights $handle [list $mol [add_highlight $mol [dict get $atoms $mol] $options]]
        }
        # On the target's molecule, where surfaces are drawn.
        if {[dict get $options face] && $found ne ""} {
            face_atoms [lindex $found end] [dict get $atoms [lindex $found end]]
        }
        return $found
    }

    # Rotates the view by the smallest angle that brings the atoms, or a place, in front of their molecule's centre; all
    # molecules alike.
    proc face_atoms {mol indices} {
        set selection [atomselect $mol "index [join $indices]"]
        finally { set place [measure center $selection] } { $selection delete }
        face_point $mol $place
    }

    proc face_point {mol place} {
        set selection [atomselect $mol all]
        finally { set middle [measure center $selection] } { $selection delete }
        set away [vecsub $place $middle]
        if {[veclength $away] < 1e-6} return
        lassign [vecnorm [vectrans [lindex [molinfo $mol get rotate_matrix] 0] $away]] x y z
        set axis [expr {hypot($x, $y) < 1e-6 ? "1 0 0" : "$y [expr {-$x}] 0"}]
        set turn [transabout $axis [expr {acos(max(-1.0, min(1.0, $z)))}] rad]
        foreach other [molinfo list] {
            if {[molinfo $other get fixed]} continue
            molinfo $other set rotate_matrix [list [transmult $turn [lindex [molinfo $other get rotate_matrix] 0]]]
        }
    }

    # Highlights one residue of each molecule by its name in a trajectory's table, such as "A:LYS 12": {molecule name
    # ...}, the target's last. `owner` stands in the place of a handle.
    proc highlight_named {owner residues {face 0}} {
        variable highlights
        forget_highlight $owner
        set shown {}
        foreach {mol name} $residues {
            if {![regexp {^(?:([^:]*):)?.* (-?\d+)(\D?)$} $name -> chain number insertion]} continue
            set indices [atoms_of_residues $mol [dict create [residue_key $chain "" $number $insertion] 1]]
            if {[llength $indices] == 0} continue
            dict lappend highlights $owner [list $mol [add_highlight $mol $indices [highlight_style]]]
            set shown [list $mol $indices]
        }
        if {$face && $shown ne ""} { face_atoms {*}$shown }
    }

    # The usual look: the defaults of the command.
    proc highlight_style {} {
        set style [dict create]
        foreach option [options_of highlight] {
            dict set style [string range [dict get $option name] 1 end] [dict get $option default]
        }
        return $style
    }

    # The rows of `core::residues` by `index`.
    proc residue_rows {handle residues} {
        set rows {}
        set known [dict create]
        foreach residue [core::residues $handle] { dict set known [dict get $residue index] $residue }
        foreach index $residues {
            if {![dict exists $known $index]} {
                fail "espdiff highlight: '$index' is not the `index` of a residue of $handle, as `espdiff\
                    residues` has it"
            }
            lappend rows [dict get $known $index]
        }
        return $rows
    }

    # Their identifiers in a molecule, as in atoms.tcl: in the target those of the partners.
    proc residue_keys {handle rows mol} {
        set keys [dict create]
        foreach side [sides_of $handle $mol] {
            foreach row $rows {
                set key [key_on $side $row]
                if {$key ne ""} { dict set keys $key 1 }
            }
        }
        return $keys
    }

    proc highlighted_molecules {handle where} {
        if {$where ni {both source target}} { return [list [vmd_molecule_id $where -mol]] }
        set molecules {}
        foreach side {source target} {
            set mol [molecule_of $handle $side]
            if {$where in [list both $side] && $mol ne "" && $mol ni $molecules} { lappend molecules $mol }
        }
        if {[llength $molecules] == 0} {
            fail "-mol: $handle came from files, or its molecules are deleted; name a molecule's id"
        }
        return $molecules
    }

    proc atoms_of_residues {mol keys} {
        if {[dict size $keys] == 0} { return {} }
        set all [atomselect $mol all]
        finally {
            set indices {}
            foreach atom [$all get {chain segname resid insertion}] index [$all list] {
                if {[dict exists $keys [residue_key {*}$atom]]} { lappend indices $index }
            }
        } { $all delete }
        return $indices
    }

    proc is_highlight {mol name} {
        variable highlights
        dict for {handle places} $highlights { if {[list $mol $name] in $places} { return 1 } }
        return 0
    }

    # VMD's name of the new representation, which stays valid when others are deleted.
    proc add_highlight {mol indices options} {
        mol addrep $mol
        set rep [expr {[molinfo $mol get numreps] - 1}]
        mol modselect $rep $mol "index [join $indices]"
        mol modstyle $rep $mol {*}[dict get $options style]
        mol modcolor $rep $mol {*}[dict get $options color]
        mol modmaterial $rep $mol Opaque
        return [mol repname $mol $rep]
    }

    # The user may have deleted some of them, or their molecules.
    proc forget_highlight {handle} {
        variable highlights
        foreach place [value_or $highlights $handle {}] {
            lassign $place mol name
            if {$mol ni [molinfo list]} continue
            set rep [mol repindex $mol $name]
            if {$rep >= 0} { mol delrep $rep $mol }
        }
        dict unset highlights $handle
    }
}
