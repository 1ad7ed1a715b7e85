# atom_colors.tcl: shows residues' values on a molecule's representations, with a legend, and restores their colours.

namespace eval ::espdiff {
    # By handle: quantity, legend (a graphics molecule), and reps: {molecule name colouring minmax} of each
    # representation as it was.
    variable atom_colors [dict create]

    # Colours a molecule's representations by the field that `carried` describes (the result of `espdiff atoms`).
    # Highlights keep their colour.
    proc show_atom_colors {handle carried} {
        variable atom_colors
        set quantity [dict get $carried quantity]
        if {[dict exists $atom_colors $handle] && [dict get $atom_colors $handle quantity] ne $quantity} {
            restore_atom_colors $handle
        }
        set mol [dict get $carried mol]
        set state [value_or $atom_colors $handle [dict create quantity $quantity legend "" reps {}]]
        set known {}
        foreach rep [dict get $state reps] { lappend known [lrange $rep 0 1] }
        for {set i 0} {$i < [molinfo $mol get numreps]} {incr i} {
            set name [mol repname $mol $i]
            if {[is_highlight $mol $name]} continue
            if {[list $mol $name] ni $known} {
                dict lappend state reps [list $mol $name [lindex [molinfo $mol get "{color $i}"] 0] \
                    [mol scaleminmax $mol $i]]
            }
            mol modcolor $i $mol [field_coloring [dict get $carried field]]
            mol scaleminmax $mol $i {*}[color_range $carried]
        }
        dict set atom_colors $handle $state
        if {[dict get $state legend] ni [molinfo list]} {
            keep_view {
                set legend [draw_legend [legend_of_atoms $handle $carried]]
                build_list $legend
            }
            dict set atom_colors $handle legend $legend
        }
        place_legends
    }

    proc field_coloring {field} { string toupper $field 0 0 }

    # Symmetric about 0, so that the middle of VMD's colour scale is 0, also for what is never negative.
    proc color_range {carried} {
        set high [expr {max(abs([dict get $carried min]), abs([dict get $carried max]))}]
        if {$high == 0} { set high 1.0 }
        list [expr {-$high}] $high
    }

    # The bar shows the user's own colour scale, by which VMD colours the atoms; its upper half where nothing is
    # negative.
    proc legend_of_atoms {handle carried} {
        set title [lindex [shown_metric [dict get $carried quantity] ""] 0]
        lassign [color_range $carried] low high
        set plan [dict create handle $handle color residues title "$title of residues" low $low high $high \
            unit [dict get $carried unit]]
        if {[dict get $carried min] >= 0} { set plan [dict merge $plan {low 0 first 545}] }
        return $plan
    }

    # The user may have deleted representations or molecules, or the legend.
    proc restore_atom_colors {handle} {
        variable atom_colors
        if {![dict exists $atom_colors $handle]} return
        foreach rep [dict get $atom_colors $handle reps] {
            lassign $rep mol name coloring minmax
            if {$mol ni [molinfo list]} continue
            set i [mol repindex $mol $name]
            if {$i < 0} continue
            mol modcolor $i $mol {*}$coloring
            # Equal ends are VMD's sign for a range that it finds itself.
            mol scaleminmax $mol $i {*}[expr {[lindex $minmax 0] == [lindex $minmax 1] ? "auto" : $minmax}]
        }
        set legend [dict get $atom_colors $handle legend]
        dict unset atom_colors $handle
        keep_view { delete_molecules [list $legend] }
        place_legends
    }

    proc uncolor {options handle} {
        require_vmd "espdiff uncolor" "outside of it nothing is coloured"
        require_core_handle $handle
        restore_atom_colors $handle
    }
}
