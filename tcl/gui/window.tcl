# window.tcl: the window "Surface Potential Comparison": its parts, opening and closing.

# The window calls only public commands of espdiff (and reads the table of settings, core::settings), so that a script
# can do whatever it does. Its parts are separate files; each has build_PART, which makes the widgets in a given frame.
# User entries are in the array `form`, settings in `setting`, and shared widgets in `widget`.
namespace eval ::espdiff::gui {
    variable window .espdiff
    variable traced {}          ;# traced variables of VMD, and the procedures called
    variable pending_update ""  ;# the `after` script that updates VMD's molecules
    variable hide_command ""    ;# VMD's command that closes a window of its menu; empty if opened by `espdiff gui`
    variable known_molecules ""
    variable fitted_width 0     ;# width that the window was given on a small screen; 0: none was
    variable is_hidden 0        ;# the window was closed by VMD's menu, which keeps it

    foreach part {widgets scrolled forms/endpoint_form forms/prepare_form forms/presets forms/settings_form forms/run_bar result_view forms/draw_form session_script
        help_window forms/matrix_form matrix_view heat_map residue_table residue_actions cause_view forms/trajectory_form trajectory_view
        trajectory_point residue_map line_plot forms/ensemble_form ensemble_view ensemble_series remembered} {
        source [file join [file dirname [info script]] $part.tcl]
    }
    unset part

    proc in_vmd {} { expr {[info commands ::molinfo] ne ""} }

    # Opens the window, or raises the one that is open; returns its path.
    proc open {} {
        variable window
        if {[winfo exists $window]} {
            wm deiconify $window
            raise $window
            shown_again
        } else {
            build
        }
        return $window
    }

    # The entry of VMD's menu opened the window: VMD has set its own command for the close button, which only withdraws
    # the window. close_window takes its place, and uses it, because VMD could not open a destroyed window again.
    proc take_close_button {} {
        variable window
        variable hide_command
        if {![winfo exists $window]} return
        set command [wm protocol $window WM_DELETE_WINDOW]
        if {$command ni {"" ::espdiff::gui::close_window}} { set hide_command $command }
        wm protocol $window WM_DELETE_WINDOW ::espdiff::gui::close_window
    }

    proc build {} {
        variable window
        # VMD gives some widgets a smaller font; here all have the same.
        option add *Espdiff*font TkDefaultFont interactive
        style_for_screen
        toplevel $window -class Espdiff
        wm withdraw $window
        wm title $window "Surface Potential Comparison"
        wm protocol $window WM_DELETE_WINDOW ::espdiff::gui::close_window
        variable widget
        # Control-Tab moves between tabs; the Tab key stays in one.
        set widget(tabs) [ttk::notebook $window.tabs -takefocus 0]
        ttk::notebook::enableTraversal $window.tabs
        foreach {name title build} {pair Pair build_pair residues Residues build_residues
            trajectory Trajectory build_trajectory matrix Matrix build_matrix ensemble Ensembles build_ensemble} {
            # The page of Pair scrolls above its buttons, the residues' list by itself.
            set tab $window.tabs.$name
            $build [expr {$name in {pair residues} ? [ttk::frame $tab] : [scrolled $tab]}]
            $window.tabs add $window.tabs.$name -text $title
        }
        pack $window.tabs -fill both -expand 1
        bind_keys
        bind $window <Destroy> {if {"%W" eq $::espdiff::gui::window} { ::espdiff::gui::closed }}
        bind $window <FocusIn> {if {"%W" eq $::espdiff::gui::window} { ::espdiff::gui::update_soon }}
        # `menu espdiff off` and `on` withdraw and show the window without calling us.
        bind $window <Unmap> {if {"%W" eq $::espdiff::gui::window} { after idle ::espdiff::gui::notice_hidden }}
        bind $window <Map> {if {"%W" eq $::espdiff::gui::window} { ::espdiff::gui::shown_again }}
        set ::espdiff::gui::is_hidden 0
        set ::espdiff::gui::hide_command ""
        trace_molecules
        load_settings
        update_molecules
        show_results
        keep_wheel_from_changing_values $window
        fit_screen
        wm deiconify $window
        focus $::espdiff::gui::widget(compare)
    }

    # Ttk's rows, arrows, marks and margins have fixed sizes in pixels, which are too small for large fonts.
    proc style_for_screen {} {
        set line [font metrics TkDefaultFont -linespace]
        ttk::style configure Espdiff.Treeview -rowheight [expr {$line + 3}]
        if {$line < 22} return
        set size [expr {round(0.65 * $line)}]
        foreach style {TCombobox TSpinbox TScrollbar} { ttk::style configure $style -arrowsize $size }
        foreach style {TCheckbutton TRadiobutton} {
            # The first is of the theme `default`, the second of clam and alt.
            ttk::style configure $style -indicatordiameter $size -indicatorsize $size -indicatormargin {1p 1p 3p 1p}
        }
        ttk::style configure TButton -padding {4p 2p}
        ttk::style configure TNotebook.Tab -padding {4p 2p}
    }

    # On a small screen the window is lower than it asks for; its page scrolls.
    proc fit_screen {} {
        variable window
        variable fitted_width
        update idletasks
        # Pages that were not shown yet have not asked for their width.
        foreach name {trajectory matrix ensemble} { fit_page $window.tabs.$name }
        update idletasks
        set fitted_width 0
        set most [expr {[winfo screenheight $window] - 60}]
        if {[winfo reqheight $window] > $most} { set_width $most }
    }

    # A window whose size was set does not grow by itself when its contents do.
    proc grow_in_width {} {
        variable window
        variable fitted_width
        update idletasks
        if {$fitted_width > 0 && [winfo width $window] == $fitted_width && [winfo reqwidth $window] > $fitted_width} {
            set_width [winfo height $window]
        }
    }

    proc set_width {height} {
        variable window
        variable fitted_width
        set fitted_width [expr {min([winfo reqwidth $window], [winfo screenwidth $window])}]
        wm geometry $window ${fitted_width}x$height
    }

    proc build_pair {outer} {
        build_run_bar $outer.run
        set body [scrolled $outer.page]
        build_page $body
        grid $outer.page -sticky news
        grid [ttk::separator $outer.line] -sticky ew
        grid $outer.run -sticky ew
        grid columnconfigure $outer 0 -weight 1
        grid rowconfigure $outer 0 -weight 1
        # In Tab key order: the page is made after the bar but comes before it.
        lower $outer.page
    }

    # The page for one comparison: inputs, settings, result, drawing.
    proc build_page {body} {
        ttk::frame $body.sides
        build_endpoint $body.sides.source source Source
        build_endpoint $body.sides.target target Target
        grid $body.sides.source $body.sides.target -sticky news
        grid columnconfigure $body.sides {0 1} -weight 1 -uniform side
        grid configure $body.sides.target -padx {6 0}
        build_settings $body.settings
        build_results $body.results
        pack $body.sides $body.settings $body.results -fill x -padx 8 -pady {4 0}
        if {[in_vmd]} {
            build_draw $body.draw
            pack $body.draw -fill x -padx 8 -pady 4
        } else {
            pack [ttk::label $body.draw -text "Drawing needs VMD. Export writes the surface for ParaView (.vtp)."] \
                -fill x -padx 8 -pady 6
        }
    }

    proc bind_keys {} {
        variable window
        foreach key {<Return> <KP_Enter>} {
            bind $window $key {::espdiff::gui::press_of_tab {pair compare trajectory trajectory,run
                matrix matrix,compute ensemble ensemble,compute}}
        }
        bind $window <Escape> {::espdiff::gui::press_of_tab {pair cancel residues residues,clear
            trajectory trajectory,cancel matrix matrix,cancel ensemble ensemble,cancel}}
        bind $window <F1> ::espdiff::gui::show_help
        bind $window <Control-w> ::espdiff::gui::close_window
    }

    # The button of a key in the open tab, from pairs of tab and button.
    proc press_of_tab {buttons} {
        if {[dict exists $buttons [open_tab]]} { press [dict get $buttons [open_tab]] }
    }

    # pair, residues, trajectory, matrix or ensemble.
    proc open_tab {} {
        variable widget
        winfo name [$widget(tabs) select]
    }

    proc show_tab {name} {
        variable widget
        $widget(tabs) select $widget(tabs).$name
    }

    # VMD writes these variables when a molecule is added, changed or deleted, and when a file has been read into one.
    proc trace_molecules {} {
        variable traced
        if {![in_vmd]} return
        set traced {::vmd_molecule ::espdiff::gui::update_soon ::vmd_initialize_structure ::espdiff::gui::update_soon
            ::vmd_trajectory_read ::espdiff::gui::update_soon ::vmd_frame ::espdiff::gui::mark_now
            ::vmd_mouse_mode ::espdiff::gui::notice_mouse_mode ::vmd_quit ::espdiff::gui::save_settings}
        foreach {name command} $traced { trace add variable $name write $command }
        if {[info exists ::vmd_mouse_mode]} notice_mouse_mode
    }

    # VMD calls this during its change.
    proc update_soon {args} {
        variable pending_update
        after cancel $pending_update
        set pending_update [after 50 {::espdiff::gui::guard ::espdiff::gui::update_molecules}]
    }

    proc update_molecules {} {
        variable window
        variable known_molecules
        if {![winfo exists $window]} return
        # An error about a molecule is out of date when the molecules change.
        set molecules [expr {[in_vmd] ? [molecule_names] : ""}]
        if {$molecules ne $known_molecules} { foreach tab {pair residues trajectory matrix ensemble} { clear_error $tab } }
        set known_molecules $molecules
        foreach side {source target} { update_endpoint $side }
        if {[in_vmd]} { update_draw }
        update_trajectory
        update_matrix
        update_ensemble
    }

    # The close button, Control-w, and `menu espdiff off` end the same way: runs cancelled, highlight removed, settings
    # saved.
    proc close_window {} {
        variable window
        variable hide_command
        if {[is_running]} {
            set answer [tk_messageBox -parent $window -type yesno -icon question -title "Surface Potential Comparison" \
                -message "A comparison is running." -detail "Cancel it and close the window?"]
            if {$answer ne "yes"} return
        }
        if {$hide_command eq ""} {
            destroy $window
        } else {
            leave_window
            uplevel #0 $hide_command
        }
    }

    proc is_running {} {
        variable running
        variable matrix_running
        variable trajectory_running
        variable ensemble_running
        expr {$running ne "" || $matrix_running ne "" || $trajectory_running ne "" || $ensemble_running ne ""}
    }

    # An iconified window stays open.
    proc notice_hidden {} {
        variable window
        if {[winfo exists $window] && [wm state $window] eq "withdrawn"} { leave_window }
    }

    proc shown_again {} {
        variable is_hidden
        if {$is_hidden} {
            set is_hidden 0
            trace_molecules
            show_trajectory_running
            show_matrix_running
            show_ensemble_running
        }
        update_molecules
        show_results
    }

    # However the window closed: leaves the results and the user's entries, nothing else.
    proc leave_window {} {
        variable traced
        variable pending_update
        variable is_hidden
        variable widget
        variable matrix_running
        variable trajectory_running
        variable ensemble_running
        if {$is_hidden} return
        set is_hidden 1
        foreach {name command} $traced { trace remove variable $name write $command }
        set traced {}
        save_settings
        after cancel $pending_update
        hide_tip
        remove_highlight
        if {[winfo exists $widget(residues,table)]} { $widget(residues,table) selection set {} }
        foreach tab {trajectory matrix ensemble} {
            if {[set ${tab}_running] ne ""} { tell_in $tab "Stopped: the window was closed." }
        }
        abandon_run
        abandon_trajectory
        abandon_matrix
        abandon_ensemble
    }

    # The window was destroyed.
    proc closed {} {
        leave_window
        forget_tips
        forget_settings
        array unset ::espdiff::gui::widget
    }
}
