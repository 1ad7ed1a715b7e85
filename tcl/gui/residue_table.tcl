# residue_table.tcl: the tab with the residues of the shown result: its widgets, rows, and their order.

namespace eval ::espdiff::gui {
    variable residues_of ""     ;# handle of the residues in the table
    variable residue_rows {}    ;# its `espdiff residues`
    variable part_rows {}       ;# by row: the numbers of region and patches under the residues' keys, and their residues
    variable form
    array set form {residues,sort share residues,falling 1 residues,face 1 residues,least 0}

    # Columns: key of `espdiff residues`, or share (area times |difference|, of the sum over all residues); heading, whether
    # it needs potentials, decimals, factor.
    variable residue_columns {}
    # Short headings; other metrics of residues have their title.
    variable residue_headings {
        mean_abs_difference |Diff.| mean_signed_difference Diff. mean_source Source mean_target Target
        sign_change_area_fraction Sign own_difference "Own diff." own_area_A2 "Own area" mean_displacement_A Moved
        mean_path_length_A Path mean_slip_A Slip slip_area_fraction Slipped trusted_area_fraction Trusted area_A2 Area
    }

    # The columns of every metric that residues have, those of potentials first.
    proc make_residue_columns {} {
        variable residue_columns {residue Residue 0 "" 1 share "Share %" 1 1 100}
        variable residue_headings
        set others {}
        foreach metric [::espdiff::core::metrics] {
            if {![dict get $metric residues]} continue
            set name [dict get $metric name]
            set heading [::espdiff::value_or $residue_headings $name [dict get $metric title]]
            lassign [dict get {fraction {" %" 0} length {" \u00c5" 2} area {" \u00c5\u00b2" 1}
                potential {"" 2} index {"" 2} count {"" 0}} [dict get $metric kind]] unit decimals
            set of_potentials [expr {[dict get $metric section] eq "potential"}]
            lappend [expr {$of_potentials ? "residue_columns" : "others"}] \
                $name $heading$unit $of_potentials $decimals [dict get $metric factor]
        }
        lappend residue_columns {*}$others
    }

    proc build_residues {path} {
        variable widget
        variable residue_columns
        variable residues_of -  ;# no handle: the table is new
        make_residue_columns
        ttk::frame $path.top
        ttk::label $path.title -anchor w -width 28 -font [bold_font]
        ttk::combobox $path.top.sort -state readonly -width 12
        bind $path.top.sort <<ComboboxSelected>> {::espdiff::gui::guard_in residues ::espdiff::gui::sort_as_chosen}
        ttk::checkbutton $path.top.falling -text "largest first" -variable ::espdiff::gui::form(residues,falling) \
            -command {::espdiff::gui::guard_in residues ::espdiff::gui::fill_residues}
        ttk::label $path.top.by -text "Sorted by"
        tip $path.top.sort "Same as a click on a heading"
        ttk::label $path.top.from -text "Area from"
        ttk::spinbox $path.top.least -textvariable ::espdiff::gui::form(residues,least) -width 4 -from 0 -to 200 \
            -increment 5 -command {::espdiff::gui::guard_in residues ::espdiff::gui::fill_residues}
        ttk::label $path.top.unit -text "\u00c5\u00b2"
        bind $path.top.least <Return> {::espdiff::gui::guard_in residues ::espdiff::gui::fill_residues; break}
        bind $path.top.least <FocusOut> {::espdiff::gui::guard_in residues ::espdiff::gui::fill_residues}
        tip $path.top.least "Residues with less surface are left out: their means say little"
        pack $path.top.by $path.top.sort $path.top.falling $path.top.from $path.top.least $path.top.unit -side left \
            -padx {0 6}
        ttk::frame $path.list
        set columns {}
        foreach {key heading of_potentials decimals factor} $residue_columns { lappend columns $key }
        ttk::treeview $path.list.table -columns $columns -show headings -height 18 -selectmode extended -style Espdiff.Treeview \
            -yscrollcommand [list $path.list.scroll set] -xscrollcommand [list $path.list.across set]
        foreach {key heading of_potentials decimals factor} $residue_columns {
            $path.list.table heading $key -command [list ::espdiff::gui::guard_in residues ::espdiff::gui::sort_by $key]
            $path.list.table column $key -width [expr {$key eq "residue" ? 86 : 76}] -stretch 0 \
                -anchor [expr {$key eq "residue" ? "w" : "e"}]
        }
        ttk::scrollbar $path.list.scroll -orient vertical -command [list $path.list.table yview] -takefocus 0
        ttk::scrollbar $path.list.across -orient horizontal -command [list $path.list.table xview] -takefocus 0
        grid $path.list.table $path.list.scroll -sticky news
        grid $path.list.across -sticky we
        # The window is narrower than all columns.
        $path.list configure -width 620 -height [expr {[winfo reqheight $path.list.table] + [winfo reqheight $path.list.across]}]
        grid propagate $path.list 0
        grid columnconfigure $path.list 0 -weight 1
        grid rowconfigure $path.list 0 -weight 1
        build_residue_buttons $path.buttons
        build_causes $path.causes
        # As high as its longest text, so that the buttons above do not move.
        ttk::frame $path.space -height [expr {3 * [font metrics TkDefaultFont -linespace] + 4}]
        pack propagate $path.space 0
        ttk::label $path.message -anchor nw -wraplength 620 -justify left
        pack $path.message -in $path.space -fill both -expand 1
        raise $path.message
        bind $path.space <Configure> [list apply {{label width} { $label configure -wraplength [expr {max(100, $width - 6)}] }} \
            $path.message %w]
        pack $path.title -fill x -padx 8 -pady {8 0}
        pack $path.top -fill x -padx 8 -pady 4
        pack $path.space -side bottom -fill x -padx 8 -pady {0 8}
        pack $path.buttons -side bottom -fill x -padx 8 -pady 4
        pack $path.list -fill both -expand 1 -padx 8
        bind $path.list.table <<TreeviewSelect>> {::espdiff::gui::guard_in residues ::espdiff::gui::highlight_chosen}
        set widget(residues,table) $path.list.table
        set widget(residues,buttons) $path.buttons
        set widget(residues,message) $path.message
        set widget(residues,title) $path.title
        foreach name {sort falling} { set widget(residues,$name) $path.top.$name }
    }

    proc build_residue_buttons {path} {
        variable widget
        ttk::frame $path
        button $path.clear "Clear highlight" ::espdiff::gui::clear_highlight
        button $path.atoms "Colour atoms" ::espdiff::gui::colour_atoms
        button $path.uncolor "Restore colours" {::espdiff::gui::guard_in residues ::espdiff::gui::restore_colours}
        button $path.export "Export CSV..." ::espdiff::gui::export_residues
        tip $path.clear "Deselect all rows and remove the highlight from VMD (Escape)"
        tip $path.atoms "Carries what the table is sorted by onto the atoms of the displayed molecules, in VMD's field\
            User, and colours their representations by it, with a legend"
        tip $path.uncolor "The representations' colours as they were before"
        tip $path.export "Write the table in its current order, with all digits"
        pack $path.export -side right
        ttk::checkbutton $path.face -text "rotate the view to it" -variable ::espdiff::gui::form(residues,face) \
            -command {::espdiff::gui::guard_in residues ::espdiff::gui::highlight_chosen}
        tip $path.face "Rotate VMD's view so that the highlighted residues are in front"
        if {[in_vmd]} { pack $path.clear $path.face $path.atoms $path.uncolor -side left -padx {0 6} }
        foreach name {clear face atoms uncolor export} { set widget(residues,$name) $path.$name }
    }

    # Shows the residues of a newly shown result.
    proc show_residues {} {
        variable shown
        variable residues_of
        variable residue_rows
        variable chosen_result
        variable widget
        if {$residues_of ne $shown} {
            set chosen [chosen_residues]
            remove_highlight
            set residues_of $shown
            set residue_rows [expr {$shown eq "" ? {} : [with_shares $shown]}]
            set_part_rows
            $widget(residues,table) selection set {}
            tell_in residues [residue_hint]
            fill_residues
            show_causes
            select_residues $chosen
        }
        $widget(residues,title) configure -text [expr {$shown eq "" ? "No comparison yet" : $chosen_result}]
        set_enabled [expr {$shown ne ""}] $widget(residues,clear) $widget(residues,atoms) $widget(residues,uncolor) $widget(residues,export) \
            $widget(residues,sort) $widget(residues,falling)
    }

    # Rows with their share of the sum of |difference| times area; empty without potentials.
    proc with_shares {handle} {
        set rows [espdiff residues $handle]
        set shares {}
        if {[espdiff result $handle potential_unit] ne ""} {
            set shares [dict get [::espdiff::core::residue_quantity $handle share] values]
        }
        set result {}
        foreach row $rows share $shares { lappend result [dict set row share $share] }
        return $result
    }

    # The rows of the region and of patches.
    proc set_part_rows {} {
        variable shown
        variable part_rows {}
        if {$shown eq ""} return
        if {![catch { espdiff result $shown region } region] && [dict exists $region residues]} {
            dict set part_rows region [part_row Region $region]
        }
        if {[catch { espdiff result $shown fixed_patches } patches]} return
        dict for {name patch} $patches { dict set part_rows "patch $name" [part_row $name $patch] }
    }

    # A part's own numbers, of OUT.json; what it has no number for stays empty.
    proc part_row {title part} {
        variable residue_rows
        variable residue_columns
        foreach {key heading of_potentials decimals factor} $residue_columns {
            dict set result $key [::espdiff::value_or $part $key ""]
        }
        dict set result residue "$title ([dict get $part n_residues])"
        dict set result residues [dict get $part residues]
        set area [dict get $part area_A2 trusted]
        dict set result area_A2 $area
        set sum 0.0
        foreach row $residue_rows {
            if {[dict get $row mean_abs_difference] eq ""} continue
            set sum [expr {$sum + [dict get $row area_A2] * [dict get $row mean_abs_difference]}]
        }
        set difference [dict get $result mean_abs_difference]
        if {$sum > 0 && $difference ne "" && $area ne ""} { dict set result share [expr {$area * $difference / $sum}] }
        return $result
    }

    # The selected residues: the structure that they belong to, and their names with chain and number.
    proc chosen_residues {} {
        variable residues_of
        variable residue_rows
        variable widget
        set chosen [$widget(residues,table) selection]
        if {$chosen eq "" || $residues_of ni [espdiff handles]} { return {} }
        set names {}
        foreach row $residue_rows { if {[dict get $row index] in $chosen} { lappend names [residue_name $row] } }
        return [list [structure_of $residues_of] $names]
    }

    # Selects the same residues in another result of the same source. A row's number means another residue there.
    proc select_residues {chosen} {
        variable shown
        variable residue_rows
        variable widget
        lassign $chosen structure names
        if {$names eq "" || $shown eq "" || $structure ne [structure_of $shown]} return
        set items {}
        foreach row $residue_rows { if {[residue_name $row] in $names} { lappend items [dict get $row index] } }
        $widget(residues,table) selection set $items
        if {$items ne ""} { $widget(residues,table) see [lindex $items 0] }
    }

    # The source's file or molecule of VMD, in any frame.
    proc structure_of {handle} {
        foreach input [espdiff result $handle inputs] {
            if {[dict get $input role] ne "source"} continue
            regsub {" frame \d+.*} [dict get $input path] {"} name
            return $name
        }
    }

    proc residue_hint {} {
        variable shown
        if {$shown eq ""} { return "Compare two states in the tab Pair; their residues are listed here." }
        set unit [potential_unit]
        set text "Means over each residue's part of the surface; Share is its part of the sum of |Diff.| times area"
        if {$unit ne ""} {
            append text "; potentials in $unit. Diff. is target - source, Sign the area whose sign changes,\
                Own diff. that without a mapping"
        }
        append text "[expr {$unit eq "" ? ";" : ","}] Moved the mean displacement."
        if {[in_vmd]} { append text " A click on a row highlights the residue in VMD." }
        if {[shown_causes] ne ""} { append text " A click on a cause below goes to its residue." }
        return $text
    }

    proc heading_font {} {
        set font [ttk::style lookup Heading -font]
        expr {$font eq "" ? "TkHeadingFont" : $font}
    }

    # A key's number for sorting; missing values sort last.
    proc residue_number {row key} {
        if {$key eq "residue"} { return [dict get $row index] }
        return [dict get $row $key]
    }

    proc sorted_residues {} {
        variable form
        variable residue_rows
        set with {}
        set without {}
        set least [string trim $form(residues,least)]
        if {![::espdiff::is_number $least]} { error "Area from: '$least' is not a number" }
        foreach row $residue_rows {
            if {$least > 0 && ([dict get $row area_A2] eq "" || [dict get $row area_A2] < $least)} continue
            set value [residue_number $row $form(residues,sort)]
            if {$value eq ""} { lappend without $row } else { lappend with [list $value $row] }
        }
        set order [expr {$form(residues,falling) ? "-decreasing" : "-increasing"}]
        set rows {}
        foreach pair [lsort -real $order -index 0 $with] { lappend rows [lindex $pair 1] }
        return [concat $rows $without]
    }

    # As the package names it, with an arrow.
    proc residue_name {row} { string map {-> \u2192} [::espdiff::residue_name $row] }

    # Fills the rows in order; selected rows stay selected.
    proc fill_residues {} {
        variable form
        variable widget
        variable part_rows
        set table $widget(residues,table)
        set selected [$table selection]
        $table delete [$table children {}]
        set_residue_headings
        # Above the residues, in any order.
        $table tag configure part -font [bold_font]
        dict for {id row} $part_rows {
            $table insert {} end -id $id -tags part -values [residue_cells $row [dict get $row residue]]
        }
        foreach row [sorted_residues] {
            $table insert {} end -id [dict get $row index] -values [residue_cells $row [residue_name $row]]
        }
        set still {}
        foreach item $selected { if {[$table exists $item]} { lappend still $item } }
        if {$still ne ""} { $table selection set $still; $table see [lindex $still 0] }
        # Start of the arrow keys.
        $table focus [lindex [concat $still [$table children {}]] 0]
    }

    proc residue_cells {row name} {
        variable residue_columns
        set cells {}
        foreach {key heading of_potentials decimals factor} $residue_columns {
            if {$key eq "residue"} { lappend cells $name; continue }
            set value [dict get $row $key]
            # Not in an expression, which would drop trailing zeros.
            set text \u2013
            if {$value ne ""} { set text [format %.*f $decimals [expr {$factor * $value}]] }
            lappend cells $text
        }
        return $cells
    }

    # Hides the columns of potentials if there are none.
    proc set_residue_headings {} {
        variable form
        variable shown
        variable widget
        variable residue_columns
        set has_potentials [expr {$shown eq "" || [potential_unit] ne ""}]
        set visible {}
        set titles {}
        foreach {key heading of_potentials decimals factor} $residue_columns {
            if {!$has_potentials && $of_potentials} continue
            lappend visible $key
            lappend titles $heading
        }
        if {$form(residues,sort) ni $visible} {
            set form(residues,sort) [expr {$has_potentials ? "share" : "mean_displacement_A"}]
        }
        set table $widget(residues,table)
        $table configure -displaycolumns $visible
        foreach key $visible title $titles {
            if {$key eq $form(residues,sort)} { append title " [expr {$form(residues,falling) ? "\u25be" : "\u25b4"}]" }
            $table heading $key -text $title
            # Wide enough for a mutation: A:LYS199 -> GLY.
            set least [font measure TkDefaultFont [expr {$key eq "residue" ? "A:WWW1999\u2192GLY" : "-99.99 "}]]
            $table column $key -width [expr {max($least, [font measure [heading_font] "$title "])}]
        }
        $widget(residues,sort) configure -values $titles
        $widget(residues,sort) set [lindex $titles [lsearch -exact $visible $form(residues,sort)]]
    }

    # A click on a heading sorts by it, largest first; a second click reverses the order.
    proc sort_by {key} {
        variable form
        set form(residues,falling) [expr {$form(residues,sort) eq $key ? !$form(residues,falling) : $key ne "residue"}]
        set form(residues,sort) $key
        fill_residues
    }

    proc sort_as_chosen {} {
        variable form
        variable widget
        set visible [$widget(residues,table) cget -displaycolumns]
        set form(residues,sort) [lindex $visible [$widget(residues,sort) current]]
        fill_residues
    }
}
