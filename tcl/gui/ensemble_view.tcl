# ensemble_view.tcl: runs an ensemble, and shows its answer: the drawing, the list of patches, their series.

namespace eval ::espdiff::gui {
    variable ensemble_running ""  ;# handle of the running computation
    variable ensemble_shown ""    ;# handle of the answer shown
    variable ensemble_run {}      ;# its arguments of `espdiff ensemble`: groups, options; replicates as in the form
    variable ensemble_patches {}  ;# its patches with their series
    variable ensemble_patch ""    ;# number of the chosen patch; empty for all
    variable ensemble_field potential  ;# that is drawn

    proc build_ensemble_bar {path} {
        build_tab_bar ensemble $path compute Compare ::espdiff::gui::run_ensemble ::espdiff::gui::cancel_ensemble \
            "Map the template onto every frame, and compare the groups (Return)" \
            "Stop the run; its frames stay in NAME.h5, and it can be resumed (Escape)"
    }

    proc build_ensemble_result {path} {
        variable widget
        ttk::frame $path.top
        wrapping_label $path.top.answer
        button $path.top.draw "Draw all" ::espdiff::gui::draw_ensemble
        button $path.top.table Table... ::espdiff::gui::ensemble_table
        ttk::combobox $path.top.field -textvariable ::espdiff::gui::ensemble_field -state readonly -width 12 -values potential
        bind $path.top.field <<ComboboxSelected>> {::espdiff::gui::guard_in ensemble ::espdiff::gui::draw_ensemble}
        tip $path.top.field "What is drawn: the potential, or a field of this ensemble. The patches are the potential's"
        tip $path.top.draw "Draw the template: the difference of the groups, faded where it is not significant"
        tip $path.top.table "The answer as the command line prints it: replicates, noise, patches, residues, warnings"
        pack $path.top.table $path.top.draw -side right -padx {6 0}
        pack $path.top.answer -side left -fill x -expand 1
        ttk::treeview $path.patches -columns {patch area difference interval p residues} -show headings -style Espdiff.Treeview -height 3 \
            -selectmode browse
        foreach {column title width stretch} {patch "" 30 0 area "Area (\u00c5\u00b2)" 75 0 difference Difference 80 0
            interval "95 % interval" 115 0 p p 55 0 residues Residues 160 1} {
            $path.patches heading $column -text $title -anchor w
            $path.patches column $column -width [scaled $width] -stretch $stretch
        }
        bind $path.patches <<TreeviewSelect>> {::espdiff::gui::guard_in ensemble ::espdiff::gui::choose_patch}
        tip $path.patches "Pieces of surface whose difference is significant; a click shows one, and its mean in every frame"
        canvas $path.plot -width 420 -height 110 -background white -highlightthickness 1 -takefocus 1 \
            -highlightbackground gray80 -highlightcolor #3060c0
        ttk::label $path.point -anchor w
        bind $path.plot <Configure> {::espdiff::gui::guard_in ensemble ::espdiff::gui::draw_series}
        bind $path.plot <Motion> {::espdiff::gui::guard_in ensemble ::espdiff::gui::tell_series_at %x}
        bind $path.plot <ButtonPress-1> {::espdiff::gui::guard_in ensemble ::espdiff::gui::show_frame_at %x}
        pack $path.top $path.patches -fill x -pady {0 4}
        pack $path.point -side bottom -fill x
        pack $path.plot -fill both -expand 1
        foreach name {answer draw table field} { set widget(ensemble,$name) $path.top.$name }
        foreach name {patches plot point} { set widget(ensemble,$name) $path.$name }
        show_ensemble_running
    }

    proc run_ensemble {} { guard_in ensemble ::espdiff::gui::start_ensemble }

    proc start_ensemble {} {
        variable form
        variable computed
        variable window
        variable ensemble_running
        variable ensemble_run
        if {$ensemble_running ne ""} return
        set output [string trim $form(ensemble,output)]
        if {$output eq ""} { error "Results: no name is given" }
        set options [list -output $output -control [string tolower $form(ensemble,control)]]
        set map [computed_map_word $form(ensemble,potential)]
        if {$map ne ""} { lappend options -map $map }
        set column [string trim $form(ensemble,regress)]
        if {$column ne ""} { lappend options -regress $column }
        if {$form(ensemble,resume)} {
            lappend options -resume 1
        } elseif {[file exists $output.h5]} {
            if {![confirm_overwrite $output]} return
            lappend options -overwrite 1
        }
        set groups [ensemble_words]
        set settings [setting_options variants]
        tell_in ensemble ""
        set ::espdiff::gui::ensemble_begun [clock milliseconds]
        set ensemble_running [espdiff ensemble $groups {*}$options {*}$settings \
            -progress ::espdiff::gui::ensemble_progress -command ::espdiff::gui::finish_ensemble]
        set ensemble_run [dict create groups $groups replicates [ensemble_order] settings $settings \
            options [dict merge [dict remove $options -resume -overwrite] [list -output [file normalize $output]]]]
        set molecules {}
        foreach {name list} $groups { lappend molecules {*}$list }
        remember_molecules ensemble $molecules
        save_settings
        show_ensemble_running
    }

    proc ensemble_progress {stage fraction} {
        # The core tells the time that is left.
        show_progress_in ensemble $stage $fraction
    }

    proc cancel_ensemble {} {
        variable ensemble_running
        cancel_run $ensemble_running
    }

    # Called by espdiff at the end, successful or not.
    proc finish_ensemble {handle} {
        variable ensemble_running
        variable form
        if {$handle ne $ensemble_running} return
        set ensemble_running ""
        show_ensemble_running
        if {[catch_labelled { espdiff wait $handle } message options]} {
            espdiff delete $handle
            set cancelled [expr {[lindex [dict get $options -errorcode] 1] eq "CANCELLED"}]
            if {$cancelled && [file exists [string trim $form(ensemble,output)].h5]} {
                set message "Stopped. With \u201cresume\u201d, Compare computes the frames that are missing."
            }
            tell_in ensemble $message [expr {$cancelled ? "note" : "error"}]
            return
        }
        guard_in ensemble ::espdiff::gui::show_ensemble $handle
    }

    proc show_ensemble {handle} {
        variable ensemble_shown
        variable ensemble_patches
        variable ensemble_patch ""
        variable widget
        if {$ensemble_shown ne "" && $ensemble_shown in [espdiff handles]} { espdiff delete $ensemble_shown }
        set ensemble_shown $handle
        set result [espdiff result $handle]
        set compares [dict exists $result test]
        set ensemble_patches [expr {$compares ? [espdiff patches $handle -series 1] : {}}]
        tell_in ensemble "[dict get $result frames] frames in [format %.0f [dict get $result seconds]] s. Written:\
            [join [lmap_tails [dict get $result files]] {, }]"
        $widget(ensemble,answer) configure -text [ensemble_answer $result]
        $widget(ensemble,patches) heading interval \
            -text "[format %.0f [expr {100 * [dict get $result options confidence]}]] % interval"
        $widget(ensemble,patches) delete [$widget(ensemble,patches) children {}]
        foreach patch $ensemble_patches {
            $widget(ensemble,patches) insert {} end -id [dict get $patch patch] -values [patch_cells $patch]
        }
        set fields [::espdiff::value_or $result fields {}]
        set ::espdiff::gui::ensemble_field potential
        $widget(ensemble,field) configure -values [concat potential $fields]
        pack forget $widget(ensemble,field)
        if {[llength $fields] > 0 && [in_vmd]} { pack $widget(ensemble,field) -side right -after $widget(ensemble,draw) }
        show_ensemble_running
        draw_series
        if {[in_vmd]} { draw_ensemble }
    }

    # The answer in two or three lines.
    proc ensemble_answer {result} {
        set text "[string toupper [dict get $result conclusion] 0]."
        if {![dict exists $result test]} { return $text }
        set unit [dict get $result potential_unit]
        dict with result test {
            append text "\nMean absolute difference [format %.3f $mean_abs_difference] $unit"
            if {$no_p_because eq ""} {
                append text " (p = [with_digits $mean_abs_difference_p]); significant: [format %.0f $significant_area_A2]\
                    of [format %.0f [dict get $result tested_area_A2]] \u00c5\u00b2"
            }
            append text "."
        }
        if {[dict exists $result fixed_patches]} {
            dict for {name patch} [dict get $result fixed_patches] { append text "\n[fixed_patch_words $name $patch $unit]" }
        }
        if {[dict exists $result regression]} {
            dict with result regression {
                set area 0.0
                foreach patch $patches { set area [expr {$area + [dict get $patch area_A2]}] }
                append text "\nOn $column: Q2 [with_digits $q2] (p = [format %.3g $q2_p]); significant: [format %.0f $area]\
                    \u00c5\u00b2."
            }
        }
        return $text[shown_warnings [::espdiff::value_or $result warnings {}]]
    }

    # So many that patches and series keep their place.
    proc shown_warnings {warnings} {
        set text ""
        foreach warning [lrange $warnings 0 1] { append text "\n\u2022 $warning" }
        set more [expr {[llength $warnings] - 2}]
        if {$more > 0} { append text "\n\u2022 $more more under Table..." }
        return $text
    }

    # "site: -1.119 (-1.331 to -0.907) kT/e, p = 1.4e-05"
    proc fixed_patch_words {name patch unit} {
        foreach key {difference low high p} { set $key [with_digits [::espdiff::value_or $patch $key ""]] }
        return "$name: $difference ($low to $high) $unit, p = $p."
    }

    # A number in a sentence, or a dash for none.
    proc with_digits {value} { expr {$value eq "" ? "\u2013" : [format %.3g $value]} }

    proc patch_cells {patch} {
        set residues {}
        foreach residue [lrange [dict get $patch residues] 0 3] { lappend residues [dict get $residue residue] }
        foreach key {area_A2 difference low high smallest_p} { set $key [dict get $patch $key] }
        return [list [dict get $patch patch] [format %.1f $area_A2] [format %.3f $difference] \
            "[format %.2f $low] to [format %.2f $high]" [format %.3g $smallest_p] [join $residues {, }]]
    }

    # The whole surface, with the molecule of the template at its frame; the others are hidden.
    proc draw_ensemble {} {
        variable widget
        variable ensemble_shown
        variable ensemble_patch ""
        $widget(ensemble,patches) selection set {}
        draw_patch 0
        draw_series
    }

    proc draw_patch {patch} {
        variable ensemble_shown
        lassign [::espdiff::ensemble_template $ensemble_shown] mol frame
        if {$mol ne ""} { show_molecule_alone $mol $frame }
        variable ensemble_field
        set options [list -patch $patch]
        if {$ensemble_field ne "potential"} { lappend options -field $ensemble_field }
        espdiff draw $ensemble_shown {*}$options
        remember ensemble draw [concat draw $options]
    }

    # Shows the selected patch from its front, and its series.
    proc choose_patch {} {
        variable widget
        variable ensemble_shown
        variable ensemble_patches
        variable ensemble_patch
        set chosen [lindex [$widget(ensemble,patches) selection] 0]
        if {$chosen eq "" || $chosen eq $ensemble_patch} return
        set ensemble_patch $chosen
        set ::espdiff::gui::ensemble_field potential  ;# whose patches they are
        if {[in_vmd]} {
            draw_patch $chosen
            lassign [::espdiff::ensemble_template $ensemble_shown] mol
            if {$mol ne ""} {
                ::espdiff::face_point $mol [dict get [lindex $ensemble_patches [expr {$chosen - 1}]] peak_A]
            }
        }
        draw_series
    }

    proc ensemble_table {} {
        variable ensemble_shown
        text_window ensemble_table "espdiff: $ensemble_shown" [espdiff table $ensemble_shown]
    }

    proc show_ensemble_running {} {
        variable widget
        variable replicates
        variable ensemble_running
        variable ensemble_shown
        variable ensemble_run
        if {![info exists widget(ensemble,table)] || ![winfo exists $widget(ensemble,table)]} return
        set idle [expr {$ensemble_running eq ""}]
        set_enabled [expr {$idle && [llength $replicates] > 0}] $widget(ensemble,compute)
        set_enabled [expr {!$idle}] $widget(ensemble,cancel)
        set_enabled [expr {$ensemble_run ne ""}] $widget(ensemble,script)
        set_enabled [expr {$ensemble_shown ne ""}] $widget(ensemble,table)
        set_enabled [expr {$ensemble_shown ne "" && [in_vmd]}] $widget(ensemble,draw)
        if {$idle} { $widget(ensemble,bar) configure -value 0 }
    }

    # The tab's window closes: cancel its run. Its frames stay in the file.
    proc abandon_ensemble {} {
        variable ensemble_running
        set handle $ensemble_running
        set ensemble_running ""
        if {$handle ne "" && $handle in [espdiff handles]} { espdiff delete $handle }
    }
}
