# trajectory_view.tcl: the run along a trajectory, and its growing plot, which leads to the frames.

namespace eval ::espdiff::gui {
    variable trajectory_running ""  ;# handle of the running computation
    variable trajectory_rows {}     ;# rows shown, dicts by column
    variable trajectory_run {}      ;# their options, output and settings, as arguments
    variable form
    array set form {trajectory,metric "" trajectory,smooth 1}

    proc build_trajectory_bar {path} {
        build_tab_bar trajectory $path run Compare ::espdiff::gui::run_trajectory ::espdiff::gui::cancel_trajectory \
            "Compare each frame with the reference (Return)" \
            "Stop the run; its rows stay in the file, and it can be resumed (Escape)"
    }

    proc build_trajectory_plot {path} {
        variable widget
        ttk::frame $path.top
        ttk::label $path.top.label -text Metric
        ttk::combobox $path.top.metric -textvariable ::espdiff::gui::form(trajectory,metric) -state readonly -width 22
        bind $path.top.metric <<ComboboxSelected>> {::espdiff::gui::guard_in trajectory ::espdiff::gui::draw_trajectory}
        button $path.top.open "Open CSV..." ::espdiff::gui::browse_rows
        button $path.top.save "Save plot..." ::espdiff::gui::save_plot
        tip $path.top.open "Rows of an earlier run"
        tip $path.top.save "Save the plot as PNG or SVG, by gnuplot; as PostScript with the running mean, as seen here"
        ttk::label $path.top.over -text "Mean over"
        ttk::spinbox $path.top.smooth -textvariable ::espdiff::gui::form(trajectory,smooth) -width 3 -from 1 -to 99 \
            -increment 2 -command {::espdiff::gui::guard_in trajectory ::espdiff::gui::draw_trajectory}
        bind $path.top.smooth <Return> {::espdiff::gui::guard_in trajectory ::espdiff::gui::draw_trajectory; break}
        tip $path.top.smooth "Frames of the running mean, drawn over the points; 1 draws none"
        pack $path.top.label $path.top.metric $path.top.over $path.top.smooth -side left -padx {0 6}
        pack $path.top.save $path.top.open -side right -padx {6 0}
        canvas $path.plot -width 420 -height 240 -background white -highlightthickness 1 -takefocus 1 \
            -highlightbackground gray80 -highlightcolor #3060c0
        ttk::frame $path.point
        wrapping_label $path.point.text
        button $path.point.compare "Compare and draw" ::espdiff::gui::compare_frame
        tip $path.point.compare "Compares the frame of the chosen point anew, with its surface, and draws it\
            (space bar)"
        pack $path.point.compare -side right
        pack $path.point.text -side left -fill x -expand 1
        pack $path.top -fill x
        pack $path.point -side bottom -fill x
        pack $path.plot -fill both -expand 1 -pady 4
        bind $path.plot <Configure> {::espdiff::gui::guard_in trajectory ::espdiff::gui::draw_trajectory}
        bind $path.plot <Motion> {::espdiff::gui::guard_in trajectory ::espdiff::gui::tell_point_at %x %y}
        bind $path.plot <Leave> {::espdiff::gui::guard_in trajectory ::espdiff::gui::tell_chosen_point}
        bind $path.plot <ButtonPress-1> {::espdiff::gui::guard_in trajectory ::espdiff::gui::choose_point_at %x %y}
        foreach {key step} {Left -1 Right 1 Home -1000000 End 1000000} {
            bind $path.plot <$key> [list ::espdiff::gui::guard_in trajectory ::espdiff::gui::move_point $step]
        }
        foreach {key step} {Up -1 Down 1} {
            bind $path.plot <$key> [list ::espdiff::gui::guard_in trajectory ::espdiff::gui::move_residue $step]
        }
        bind $path.plot <space> {::espdiff::gui::press trajectory,compare; break}
        set widget(trajectory,plot) $path.plot
        set widget(trajectory,point) $path.point.text
        set widget(trajectory,compare) $path.point.compare
        foreach name {metric open save} { set widget(trajectory,$name) $path.top.$name }
        if {![in_vmd]} { $path.point.compare configure -text Compare }
    }

    proc run_trajectory {} { guard_in trajectory ::espdiff::gui::start_trajectory }

    proc start_trajectory {} {
        variable form
        variable trajectory_running
        variable trajectory_rows
        variable trajectory_run
        variable chosen_point
        if {$trajectory_running ne ""} return
        set csv [string trim $form(trajectory,csv)]
        if {$csv eq ""} { error "Results: no name is given" }
        # What is wrong with them is told before the question about the file.
        set options [trajectory_options]
        set settings [setting_options all]
        set output [list -csv $csv]
        if {$form(trajectory,residues)} { lappend output -residues [residue_file_of $csv] }
        if {$form(trajectory,resume)} {
            lappend output -resume 1
        } elseif {[file exists $csv]} {
            if {![confirm_overwrite $csv]} return
            lappend output -overwrite 1
        }
        tell_in trajectory ""
        set ::espdiff::gui::trajectory_begun [clock milliseconds]
        set trajectory_running [espdiff trajectory {*}$options {*}$output {*}$settings \
            -callback ::espdiff::gui::add_row -progress ::espdiff::gui::trajectory_progress \
            -command ::espdiff::gui::finish_trajectory]
        save_settings
        set trajectory_run [dict create options $options output [list -csv [file normalize $csv]] settings $settings]
        remember_trajectory
        set trajectory_rows [expr {$form(trajectory,resume) ? [rows_of $csv] : {}}]
        set chosen_point ""
        forget_residue_map
        show_trajectory_running
        draw_trajectory
    }

    proc remember_trajectory {} {
        variable trajectory_run
        set options [dict get $trajectory_run options]
        remember_molecules trajectory [expr {[dict exists $options -mol] ? [list [list mol [dict get $options -mol]]]
            : {}}]
    }

    # Rows already in a file; none at the start of a run.
    proc rows_of {csv} {
        if {![file exists $csv] || [file size $csv] == 0} { return {} }
        return [dict get [::espdiff::plot_csv $csv] rows]
    }

    # Called by espdiff after each row.
    proc add_row {frame row} {
        variable trajectory_rows
        lappend trajectory_rows $row
        variable residue_stale 1
        guard_in trajectory ::espdiff::gui::draw_trajectory
    }

    proc trajectory_progress {stage fraction} {
        if {[regexp {^frame (\d+): (.*)$} $stage -> frame step]} {
            set stage "Frame $frame: [string tolower [stage_words $step] 0 0]..."
        }
        variable trajectory_begun
        show_progress_in trajectory $stage[time_left $trajectory_begun $fraction] $fraction
    }

    proc cancel_trajectory {} {
        variable trajectory_running
        cancel_run $trajectory_running
    }

    # Called by espdiff at the end, successful or not.
    proc finish_trajectory {handle} {
        variable trajectory_running
        variable trajectory_rows
        if {$handle ne $trajectory_running} return
        set trajectory_running ""
        if {[catch_labelled { espdiff result $handle } result options]} {
            set cancelled [expr {[lindex [dict get $options -errorcode] 1] eq "CANCELLED"}]
            if {$cancelled} {
                set result "Stopped: the file has [llength $trajectory_rows] rows. With\
                    \u201cresume\u201d, Compare computes the rest."
            }
            tell_in trajectory $result [expr {$cancelled ? "note" : "error"}]
        } else {
            set bad 0
            set warned {}
            foreach row $trajectory_rows {
                if {![row_is_good $row]} { incr bad }
                if {[dict get $row warnings] ne ""} { lappend warned [dict get $row warnings] }
            }
            set about [expr {$warned eq "" ? "" : " [llength $warned] with a warning: [lindex $warned end]"}]
            set there [expr {[dict get $result resumed] == 0 ? "" : ", [dict get $result resumed] were there already"}]
            tell_in trajectory "[dict get $result rows] rows in [format %.1f [dict get $result seconds]] s$there;\
                [expr {$bad == 0 ? "all" : [llength $trajectory_rows] - $bad}] trustworthy. Written:\
                [file tail [dict get $result csv]].$about"
        }
        espdiff delete $handle
        show_trajectory_running
        variable residue_pause_until 0
        guard_in trajectory ::espdiff::gui::draw_trajectory
    }

    proc row_is_good {row} {
        expr {[dict get $row trustworthy] eq "1" || [dict get $row trustworthy] eq "true"}
    }

    proc show_trajectory_running {} {
        variable widget
        variable trajectory_running
        variable trajectory_rows
        variable trajectory_run
        variable chosen_point
        variable form
        if {![info exists widget(trajectory,compare)] || ![winfo exists $widget(trajectory,compare)]} return
        set idle [expr {$trajectory_running eq ""}]
        set has_rows [expr {[llength $trajectory_rows] > 0}]
        set_enabled [expr {$idle && (![in_vmd] || $form(trajectory,mol) ne "")}] $widget(trajectory,run)
        set_enabled $idle $widget(trajectory,open)
        set_enabled [expr {!$idle}] $widget(trajectory,cancel)
        set_enabled $has_rows $widget(trajectory,metric)
        set_enabled [expr {$idle && $has_rows}] $widget(trajectory,save)
        set_enabled [expr {$trajectory_run ne ""}] $widget(trajectory,script)
        set_enabled [expr {$chosen_point ne ""}] $widget(trajectory,compare)
        if {$idle} { $widget(trajectory,bar) configure -value 0 }
    }

    proc browse_rows {} {
        variable window
        set path [tk_getOpenFile -parent $window -filetypes {{"Tables" .csv} {"All files" *}}]
        if {$path ne ""} { guard_in trajectory ::espdiff::gui::open_rows $path }
    }

    # Assigns rows of an earlier run to the current form, because the file names no molecule of VMD.
    proc open_rows {path} {
        variable form
        variable trajectory_rows
        variable trajectory_run
        variable chosen_point
        set rows [rows_of $path]
        if {[llength $rows] == 0} { error "'$path' has no rows" }
        set form(trajectory,csv) $path
        set trajectory_rows $rows
        set trajectory_run [dict create options [trajectory_options] output [list -csv [file normalize $path]] \
            settings [setting_options all]]
        remember_trajectory
        set chosen_point ""
        forget_residue_map
        tell_in trajectory "[llength $rows] rows of [file tail $path]"
        show_trajectory_running
        draw_trajectory
    }

    proc save_plot {} {
        variable window
        variable form
        set path [tk_getSaveFile -parent $window -title "Save the plot" -defaultextension .svg \
            -initialfile [file rootname [file tail $form(trajectory,csv)]].svg \
            -filetypes {{"Scalable picture" .svg} {"Picture" .png} {"As seen here, PostScript" .ps}}]
        if {$path ne ""} { guard_in trajectory ::espdiff::gui::save_plot_as $path }
    }

    proc save_plot_as {path} {
        variable trajectory_run
        variable widget
        if {[string tolower [file extension $path]] in {.ps .eps}} {
            $widget(trajectory,plot) postscript -file $path -colormode color
            tell_in trajectory "Written: $path, as it is seen here"
            return
        }
        if {[shows_residue_map]} {
            espdiff plot [residue_file_of [dict get $trajectory_run output -csv]] -file $path -overwrite 1
            tell_in trajectory "Written: $path"
            return
        }
        set metric [lindex [chosen_trajectory_metric] 0]
        espdiff plot [dict get $trajectory_run output -csv] -metrics [list $metric] -file $path -overwrite 1
        dict set trajectory_run plot [list -metrics [list $metric] -file $path]
        tell_in trajectory "Written: $path"
    }

    # Column, title, unit, factor of what is chosen, the usual metric where nothing is. Metrics without any value are
    # not offered.
    proc chosen_trajectory_metric {} {
        variable form
        variable widget
        variable trajectory_rows
        set unit ""
        foreach row $trajectory_rows {
            if {[dict get $row potential_unit] ne ""} { set unit [dict get $row potential_unit] }
        }
        set offered {}
        foreach column [::espdiff::metric_names series] {
            foreach row $trajectory_rows {
                if {[::espdiff::is_number [::espdiff::value_or $row $column ""]]} {
                    lappend offered [concat $column [::espdiff::shown_metric $column $unit]]
                    break
                }
            }
        }
        set titles {}
        foreach metric $offered { lappend titles [lindex $metric 1] }
        variable residue_table
        if {$residue_table eq "" && $titles ne ""} { update_residue_table }
        set by_residue [residue_map_title]
        $widget(trajectory,metric) configure -values [concat $titles [expr {$by_residue eq "" ? {} : [list $by_residue]}]]
        if {$titles eq ""} { return {} }
        if {$by_residue ne "" && $form(trajectory,metric) eq $by_residue} { return [lindex $offered 0] }
        if {$form(trajectory,metric) ni $titles} {
            set usual [lindex [::espdiff::shown_metric [::espdiff::usual_metric [expr {$unit ne ""}]] $unit] 0]
            set form(trajectory,metric) [expr {$usual in $titles ? $usual : [lindex $titles 0]}]
        }
        return [lindex $offered [lsearch -exact $titles $form(trajectory,metric)]]
    }

    # The tab's window closes: cancel its run. Its rows stay in the file.
    proc abandon_trajectory {} {
        variable trajectory_running
        set handle $trajectory_running
        set trajectory_running ""
        if {$handle ne "" && $handle in [espdiff handles]} { espdiff delete $handle }
    }
}
