# residue_actions.tcl: what is done with the rows of the table of residues: highlights and colours in VMD, CSV export.

namespace eval ::espdiff::gui {
    variable highlighted ""  ;# handle with a highlight in VMD

    # Highlights the selected rows' residues in VMD, replacing the previous ones.
    proc highlight_chosen {} {
        variable form
        variable shown
        variable widget
        variable highlighted
        set chosen [$widget(residues,table) selection]
        choose_reading_of $chosen
        if {![in_vmd] || $shown eq ""} return
        if {$chosen eq ""} {
            if {$highlighted ne ""} { remove_highlight; tell_in residues [residue_hint] }
            return
        }
        set names {}
        foreach item $chosen { lappend names [lindex [$widget(residues,table) item $item -values] 0] }
        variable part_rows
        set residues {}
        foreach item $chosen {
            lappend residues {*}[expr {[dict exists $part_rows $item] ? [dict get $part_rows $item residues] : $item}]
        }
        set chosen [lsort -integer -unique $residues]
        set words [list $chosen]
        if {$form(residues,face)} { lappend words -face 1 }
        set molecules [espdiff highlight $shown {*}$words]
        set highlighted $shown
        remember $shown highlight [concat highlight $words]
        if {[llength $names] > 6} { set names [concat [lrange $names 0 5] ...] }
        tell_in residues "[join $names {, }] highlighted in [expr {[llength $molecules] == 1 ? "molecule"
            : "molecules"}] [join $molecules { and }]."
    }

    proc clear_highlight {} {
        variable widget
        $widget(residues,table) selection set {}
        remove_highlight
        tell_in residues [residue_hint]
    }

    proc remove_highlight {} {
        variable highlighted
        set handle $highlighted
        set highlighted ""
        if {$handle eq "" || $handle ni [espdiff handles]} return
        espdiff highlight $handle {}
        forget $handle highlight
    }

    proc colour_atoms {} { guard_in residues ::espdiff::gui::carry_onto_atoms }

    # Carries the sorted column onto the atoms of the compared molecules that are displayed.
    proc carry_onto_atoms {} {
        variable form
        variable shown
        set quantity $form(residues,sort)
        if {$quantity eq "residue"} { error "sort by the column that should colour the atoms" }
        set molecules {}
        foreach {side mol} [displayed_sides $shown] {
            set words [list -quantity $quantity -mol $side -show 1]
            set carried [espdiff atoms $shown {*}$words]
            remember $shown atoms.$side [concat atoms $words]
            lappend molecules $mol
        }
        set many [expr {[llength $molecules] > 1}]
        tell_in residues "Molecule[expr {$many ? "s" : ""}] [join $molecules { and }] [expr {$many ? "are" : "is"}]\
            coloured by the field User: $quantity, [with_unit [dict get $carried min]] to\
            [with_unit [dict get $carried max] [dict get $carried unit]]."
    }

    # The compared molecules that VMD displays: side, molecule, ... One that is both sides is named once.
    proc displayed_sides {handle} {
        set sides {}
        set known {}
        foreach side {source target} {
            set mol [::espdiff::molecule_of $handle $side]
            if {$mol eq "" || $mol in [dict values $sides]} continue
            lappend known $mol
            if {[molinfo $mol get displayed]} { lappend sides $side $mol }
        }
        if {$sides ne ""} { return $sides }
        if {$known eq ""} { error "the compared molecules are not in VMD: they came from files, or are deleted" }
        error "molecule[expr {[llength $known] > 1 ? "s" : ""}] [join $known { and }] of this comparison\
            [expr {[llength $known] > 1 ? "are" : "is"}] hidden; show one by the D in VMD's list, then colour its atoms"
    }

    proc restore_colours {} {
        variable shown
        espdiff uncolor $shown
        foreach side {source target} { forget $shown atoms.$side }
        tell_in residues [residue_hint]
    }

    proc export_residues {} {
        variable window
        variable shown
        set path [tk_getSaveFile -parent $window -title "Export the table" -initialfile $shown.residues.csv \
            -defaultextension .csv -filetypes {{"Tables" .csv} {"All files" *}}]
        if {$path ne ""} { guard_in residues ::espdiff::gui::write_residues $path }
    }

    # In the table's order; written under another name first, so that the file is always complete.
    proc write_residues {path} {
        variable residue_rows
        set rows [sorted_residues]
        set columns [dict keys [lindex $rows 0]]
        set lines [list $columns]
        foreach row $rows { lappend lines [dict values $row] }
        write_whole_file $path "# [side_titles], potentials in [potential_unit]\n[::espdiff::core::csv_text $lines]"
        tell_in residues "Written: $path ([llength $rows] residues)"
    }

    proc side_titles {} {
        variable shown
        return [::espdiff::comparison_name $shown]
    }
}
