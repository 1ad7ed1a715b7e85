# cause_view.tcl: whose charges make the difference of a patch, below the table of residues; a click goes to the residue.

namespace eval ::espdiff::gui {
    variable cause_rows {}     ;# by item: an entry of `espdiff result HANDLE causes`, its `largest`
    variable cause_reading ""  ;# the reading shown: region, patch NAME, residue CHAIN:NUMBER, whole

    # Key of an entry, heading, decimals; empty for texts.
    variable cause_columns {
        residue "Made by" "" difference Adds 3 source Source 3 target Target 3 distance_A "Distance \u00c5" 1
        change "What changed" "" known Place ""
    }

    # Packed by show_causes only.
    proc build_causes {path} {
        variable widget
        variable cause_columns
        ttk::frame $path
        ttk::frame $path.top
        ttk::label $path.top.title -text "Whose charges make it:" -font [bold_font]
        ttk::combobox $path.top.reading -textvariable ::espdiff::gui::cause_reading -state readonly -width 16
        bind $path.top.reading <<ComboboxSelected>> {::espdiff::gui::guard_in residues ::espdiff::gui::fill_causes}
        tip $path.top.reading "The difference that is taken apart; a click on a region or patch above chooses it"
        ttk::label $path.top.sum
        pack $path.top.title $path.top.reading $path.top.sum -side left -padx {0 6}
        set keys {}
        foreach {key heading decimals} $cause_columns { lappend keys $key }
        ttk::treeview $path.table -columns $keys -show headings -height 6 -selectmode browse -style Espdiff.Treeview \
            -yscrollcommand [list $path.scroll set]
        foreach {key heading decimals} $cause_columns {
            $path.table heading $key -text $heading
            set letters [dict get {residue WWW1999M difference -0.0000 source -0.0000 target -0.0000
                distance_A Distance_A_ change "side chain turned, chi 1 by 132 degrees" known "poorly known"} $key]
            $path.table column $key -width [font measure TkDefaultFont $letters] -stretch [expr {$key eq "change"}] \
                -anchor [expr {$decimals eq "" ? "w" : "e"}]
        }
        ttk::scrollbar $path.scroll -orient vertical -command [list $path.table yview] -takefocus 0
        grid $path.top - -sticky ew -pady {4 2}
        grid $path.table $path.scroll -sticky news
        grid columnconfigure $path 0 -weight 1
        bind $path.table <<TreeviewSelect>> {::espdiff::gui::guard_in residues ::espdiff::gui::go_to_cause}
        array set widget [list causes $path causes,table $path.table causes,reading $path.top.reading \
            causes,sum $path.top.sum]
    }

    # The causes of the shown result; hidden where it has none.
    proc show_causes {} {
        variable widget
        variable cause_reading
        set names {}
        foreach reading [shown_causes] { lappend names [dict get $reading reading] }
        $widget(causes,reading) configure -values $names
        if {$cause_reading ni $names} { set cause_reading [lindex $names 0] }
        if {$names eq ""} {
            pack forget $widget(causes)
        } else {
            pack $widget(causes) -side bottom -fill x -padx 8 -after $widget(residues,buttons)
        }
        fill_causes
    }

    proc shown_causes {} {
        variable shown
        if {$shown eq "" || [catch { espdiff result $shown causes } causes]} { return {} }
        return $causes
    }

    proc fill_causes {} {
        variable widget
        variable cause_rows {}
        variable cause_reading
        variable cause_columns
        set table $widget(causes,table)
        $table delete [$table children {}]
        $widget(causes,sum) configure -text ""
        foreach reading [shown_causes] {
            if {[dict get $reading reading] ne $cause_reading} continue
            set text "[format %+.3g [dict get $reading difference]] [dict get $reading unit]"
            set poor [dict get $reading poorly_known]
            if {$poor ne ""} { append text ", [format %+.3g $poor] of it from places poorly known" }
            $widget(causes,sum) configure -text $text
            foreach cause [dict get $reading largest] {
                set cells {}
                foreach {key heading decimals} $cause_columns { lappend cells [cause_cell $cause $key $decimals] }
                dict set cause_rows [$table insert {} end -values $cells] $cause
            }
        }
        $table focus [lindex [$table children {}] 0]
    }

    proc cause_cell {cause key decimals} {
        switch $key {
            change {
                set words [list [string map {_ " "} [dict get $cause kind]]]
                if {[dict get $cause detail] ne ""} { lappend words [dict get $cause detail] }
                return [join $words ", "]
            }
            known { return [expr {[dict get $cause poorly_known] ? "poorly known" : ""}] }
        }
        set value [dict get $cause $key]
        if {$value eq ""} { return \u2013 }
        return [expr {$decimals eq "" ? $value : [format %.${decimals}f $value]}]
    }

    # Chooses the reading of the rows that were clicked: a region's, a patch's, or a residue's if it has one.
    proc choose_reading_of {items} {
        variable widget
        variable cause_reading
        variable residue_rows
        set readings [$widget(causes,reading) cget -values]
        foreach item $items {
            set names [list $item]
            foreach row $residue_rows {
                if {[dict get $row index] ne $item} continue
                set number [dict get $row number][dict get $row insertion]
                set names [list "residue [dict get $row chain]:$number" "residue $number"]
            }
            foreach name $names {
                if {$name ni $readings || $name eq $cause_reading} continue
                set cause_reading $name
                fill_causes
            }
        }
    }

    # Selects the cause's residue in the table above, which highlights it in VMD and rotates the view to it. One that
    # the table leaves out, or that the source lacks, is highlighted all the same.
    proc go_to_cause {} {
        variable widget
        variable shown
        variable form
        variable cause_rows
        set item [$widget(causes,table) selection]
        if {$item eq ""} return
        set cause [dict get $cause_rows $item]
        set index [row_of_cause $cause]
        set table $widget(residues,table)
        if {$index ne "" && [$table exists $index]} {
            $table selection set $index
            $table see $index
            return
        }
        if {![in_vmd]} return
        if {$index ne ""} {
            espdiff highlight $shown [list $index] -face $form(residues,face)
        } else {
            set mol [::espdiff::molecule_of $shown target]
            set name "[dict get $cause chain]:[dict get $cause name] [dict get $cause number][dict get $cause insertion_code]"
            if {$mol ne ""} { ::espdiff::highlight_named $shown [list $mol $name] $form(residues,face) }
        }
        variable highlighted $shown
        tell_in residues "[dict get $cause residue] highlighted; the table above does not list it."
    }

    # The `index` of the cause's residue in the source; empty where the target alone has it.
    proc row_of_cause {cause} {
        variable residue_rows
        if {[dict get $cause place source] eq ""} { return "" }
        foreach row $residue_rows {
            if {[dict get $row chain] eq [dict get $cause chain] && [dict get $row number] eq [dict get $cause number] &&
                [dict get $row insertion] eq [dict get $cause insertion_code]} { return [dict get $row index] }
        }
        return ""
    }
}
