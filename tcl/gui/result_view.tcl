# result_view.tcl: the result of a comparison: numbers, verdict, table and export.

namespace eval ::espdiff::gui {
    variable shown ""  ;# handle of the numbers shown
    variable chosen_result ""  ;# its entry in the list of results

    # Rows of the core's table of metrics that are shown, potentials in the left column and shapes in the right one.
    proc shown_metrics {sections} {
        set rows {}
        foreach metric [::espdiff::core::metrics] {
            if {[dict get $metric section] in $sections && [dict get $metric keys] ne ""} { lappend rows $metric }
        }
        return $rows
    }

    proc build_results {path} {
        variable widget
        ttk::labelframe $path -text Result -padding {6 3}
        ttk::frame $path.top
        ttk::combobox $path.top.list -textvariable ::espdiff::gui::chosen_result -state readonly -width 24 \
            -postcommand {::espdiff::gui::guard ::espdiff::gui::list_results}
        tip $path.top.list "All results, including those of scripts"
        bind $path.top.list <<ComboboxSelected>> {::espdiff::gui::guard ::espdiff::gui::choose_result}
        button $path.top.table Table... ::espdiff::gui::show_table 0
        button $path.top.view Viewer ::espdiff::gui::view_result 0
        button $path.top.export Export... ::espdiff::gui::export 0
        button $path.top.report Report... ::espdiff::gui::report 2
        button $path.top.delete Delete ::espdiff::gui::delete_result 2
        tip $path.top.table "All numbers, as the command line prints them"
        tip $path.top.view "Open the result in espdiff's viewer: both maps at every pixel, cartoon, field lines,\
            pictures for print"
        tip $path.top.export "Write numbers (.json), mapped surface (.vtp) and residues (.csv)"
        tip $path.top.report "Write one page for any browser: the surface to be turned, residues, numbers, verdict"
        tip $path.top.delete "Free this result and its drawing"
        grid $path.top.list $path.top.view $path.top.table $path.top.export $path.top.report $path.top.delete -sticky ew -padx {0 6}
        grid configure $path.top.delete -padx 0
        grid columnconfigure $path.top 0 -weight 1
        # What the result came from: the form above may have changed since.
        wrapping_label $path.origin -foreground gray40
        set widget(result,origin) $path.origin
        build_verdict $path.verdict
        ttk::frame $path.numbers
        build_numbers $path.numbers 0 13 [shown_metrics potential]
        build_numbers $path.numbers 3 10 [shown_metrics {superposition shape surface}]
        grid columnconfigure $path.numbers {1 4} -weight 1
        grid columnconfigure $path.numbers 2 -minsize 16
        pack $path.top $path.verdict $path.numbers -fill x -pady {0 2}
        foreach name {list view table export report delete} { set widget(result,$name) $path.top.$name }
    }

    # A coloured band: one bold line, and reasons if there are any.
    proc build_verdict {path} {
        variable widget
        frame $path -padx 8 -pady 4
        ttk::label $path.title -font [bold_font] -anchor w
        wrapping_label $path.reasons
        pack $path.title $path.reasons -fill x
        set widget(verdict) $path
        set widget(verdict_title) $path.title
        set widget(reasons) $path.reasons
    }

    proc say_verdict {title reasons background foreground} {
        variable widget
        $widget(verdict) configure -background $background
        foreach path [list $widget(verdict_title) $widget(reasons)] {
            $path configure -background $background -foreground $foreground
        }
        $widget(verdict_title) configure -text $title
        $widget(reasons) configure -text [join $reasons \n]
        if {[llength $reasons] > 0} { pack $widget(reasons) -fill x } else { pack forget $widget(reasons) }
    }

    # `width` in letters fits any value but those in vacuum, so that the window does not change size with the numbers.
    proc build_numbers {parent column width numbers} {
        variable widget
        set row 0
        foreach metric $numbers {
            set label [ttk::label $parent.name$column$row -text [dict get $metric title]]
            set value [ttk::label $parent.value$column$row -anchor e -width -$width -text "\u2013"]
            grid $label -row $row -column $column -sticky w
            grid $value -row $row -column [expr {$column + 1}] -sticky e -padx {6 0}
            tip $label [dict get $metric help]
            set widget([concat number [dict get $metric keys]]) $value
            incr row
        }
    }

    # The finished comparisons, newest first: "comparison2: wild -> adk #97", where #97 is a frame.
    proc result_names {} {
        set names {}
        foreach handle [lsort -dictionary -decreasing [espdiff handles]] {
            set status [espdiff status $handle]
            if {[dict get $status kind] ne "comparison" || [dict get $status state] ne "done"} continue
            lappend names "$handle: [string map {-> \u2192} [::espdiff::comparison_name $handle]]"
        }
        return $names
    }

    # Atoms and potentials of both sides, one line each.
    proc origin_of {handle} {
        if {$handle eq ""} { return "" }
        set lines {}
        foreach side {source target} {
            set words {}
            foreach input [espdiff result $handle inputs] {
                if {[dict get $input role] eq $side} {
                    set name [dict get $input path]
                    if {![regsub {^mol (\d+) "(.*)" frame (\d+) sel} $name {\1: \2, frame \3, atoms} name]} {
                        set name [file tail $name]
                    }
                    set words [linsert $words 0 $name]
                } elseif {[dict get $input role] eq "${side}_map"} {
                    set map [dict get $input path]
                    if {[dict exists $input computed]} { set map [dict get $input computed label] }
                    regsub {^mol \d+ ".*" map (\d+)$} $map {data set \1} map
                    lappend words "potential: [expr {[dict exists $input computed] ? $map : [file tail $map]}]"
                }
            }
            lappend lines "[string totitle $side] [join $words {, }]"
        }
        return [join $lines \n]
    }

    proc list_results {} {
        variable widget
        set names [result_names]
        $widget(result,list) configure -values $names
        return $names
    }

    proc choose_result {} {
        variable chosen_result
        show_results [lindex [split $chosen_result :] 0]
    }

    # Shows a result: the given one, otherwise the one shown already, otherwise the newest; none if there is none.
    proc show_results {{handle ""}} {
        variable shown
        variable chosen_result
        variable widget
        set names [list_results]
        if {$handle ne ""} { set shown $handle }
        set chosen_result [lsearch -inline -glob $names "$shown:*"]
        if {$chosen_result eq "" || $shown eq ""} { set chosen_result [lindex $names 0] }
        set shown [lindex [split $chosen_result :] 0]
        $widget(result,origin) configure -text [origin_of $shown]
        if {$shown eq ""} {
            pack forget $widget(result,origin)
        } else {
            pack $widget(result,origin) -before $widget(verdict) -fill x -pady {0 4}
        }
        show_verdict
        show_numbers
        set_enabled [expr {$shown ne ""}] $widget(result,list) $widget(result,view) $widget(result,table) \
            $widget(result,export) $widget(result,report) $widget(result,delete)
        show_residues
        if {[in_vmd]} { update_draw }
    }

    proc show_verdict {} {
        variable shown
        if {$shown eq ""} {
            say_verdict "No comparison yet" {"Choose source and target, and press Compare."} gray90 gray30
            return
        }
        set certificate [labelled { espdiff result $shown certificate }]
        set warnings {}
        foreach warning [labelled { espdiff result $shown warnings }] {
            if {![dict get $warning refuses]} { lappend warnings "\u2022 [dict get $warning text]" }
        }
        set because [espdiff result $shown motions because]
        if {$because ne ""} {
            set used [espdiff result $shown motions domains]
            lappend warnings "\u2022 mapped twice, kept [expr {$used eq {local} ? {local motions}
                : {the superposition of the whole}}]: $because"
        }
        set verdict [dict get $certificate verdict]
        if {[dict get $certificate trustworthy]} {
            set parts {}
            if {$verdict ne "TRUSTWORTHY"} {
                foreach part [dict get $certificate untrusted_parts] { lappend parts "\u2022 not trusted: $part" }
            }
            set shares [dict get $certificate trusted_area_fraction]
            set rests [format "The numbers rest on %.3g %% of the source's surface and %.3g %% of the target's." \
                [expr {100 * [dict get $shares source]}] [expr {100 * [dict get $shares target]}]]
            say_verdict [string toupper [string tolower $verdict] 0 0] [concat [list $rests] $parts $warnings] \
                #d3efd8 #0b4a1c
            return
        }
        set reasons {}
        foreach reason [dict get $certificate reasons] { lappend reasons "\u2022 $reason" }
        say_verdict "Not trustworthy" [concat $reasons $warnings] #ffe3b0 #5c3300
    }

    proc show_numbers {} {
        variable shown
        variable widget
        foreach metric [shown_metrics {superposition potential shape surface}] {
            set keys [dict get $metric keys]
            set value [expr {$shown eq "" ? "" : [espdiff result $shown {*}$keys]}]
            if {$value ne ""} { set value [expr {[dict get $metric factor] * $value}] }
            set unit [dict get $metric unit]
            switch $unit {
                potential { set unit [expr {$value eq "" ? "" : [potential_unit]}] }
                % { set unit "% of area" }
                default { set unit [string map [list A \u00c5 ^2 \u00b2] $unit] }
            }
            $widget([concat number $keys]) configure -text [with_unit $value $unit]
        }
        fit_page_of $widget(verdict)
    }

    # Empty without potentials.
    proc potential_unit {} {
        variable shown
        set unit [espdiff result $shown potential_unit]
        expr {$unit eq "unknown" ? "(unit?)" : $unit}
    }

    proc show_table {} {
        variable shown
        text_window table "espdiff: $shown" [espdiff table $shown]
    }

    proc view_result {} {
        variable shown
        espdiff view $shown
        show_message "The viewer is starting; press h there for its keys."
    }

    proc export {} {
        variable window
        variable shown
        set prefix [tk_getSaveFile -parent $window -title "Export $shown: names begin with" -initialfile $shown]
        if {$prefix ne ""} { export_to [file rootname $prefix] }
    }

    # The dialog asks about a file named `prefix`; the results have further endings.
    proc export_to {prefix} {
        variable shown
        set replaced {}
        foreach ending {.json .vtp .residues.csv .source.pqr .target.pqr} {
            if {[file exists $prefix$ending]} { set replaced {-overwrite 1} }
        }
        if {$replaced ne "" && ![confirm_overwrite $prefix]} return
        set files [espdiff export $shown $prefix {*}$replaced]
        remember $shown export [list export [beside $prefix] -overwrite 1]
        set names {}
        foreach path $files { lappend names [file tail $path] }
        show_message "Written to [file dirname [file normalize $prefix]]: [join $names {, }]"
    }

    proc report {} {
        variable window
        variable shown
        set path [tk_getSaveFile -parent $window -title "Page of $shown" -initialfile $shown.html \
            -defaultextension .html -filetypes {{"Pages" .html} {"All files" *}}]
        if {$path ne ""} { report_to $path }
    }

    proc report_to {path} {
        variable shown
        espdiff report $shown -output $path -overwrite 1
        remember $shown report [list report -output [beside $path] -overwrite 1]
        show_message "Written: $path; any browser opens it."
    }

    # Results that a script deleted are not shown any more.
    proc notice_deleted_results {} {
        variable shown
        variable window
        if {[winfo exists $window] && $shown ne "" && $shown ni [espdiff handles]} { guard ::espdiff::gui::show_results }
    }

    proc delete_result {} {
        variable shown
        espdiff delete $shown
        forget $shown
        show_message "$shown is deleted."
        show_results
    }
}
