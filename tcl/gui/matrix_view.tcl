# matrix_view.tcl: runs a matrix and shows its heat map, which leads to its pairs.

namespace eval ::espdiff::gui {
    variable matrix_running ""  ;# handle of the running computation
    variable matrix_shown ""    ;# handle of the heat map shown
    variable matrix_result {}   ;# its `espdiff result`
    variable matrix_pairs {}    ;# its endpoints and settings
    variable matrix_run {}      ;# the same as arguments of `espdiff matrix`: variants, output, settings, template
    variable draw_when_done ""  ;# comparison to draw when it is done
    variable form
    array set form {matrix,metric "" matrix,ordered 0}

    proc build_matrix_bar {path} {
        build_tab_bar matrix $path compute Compare ::espdiff::gui::compute_matrix ::espdiff::gui::cancel_matrix \
            "Compare each variant with each other one, in both directions (Return)" \
            "Stop the computation; finished pairs are kept, and the run can be resumed (Escape)"
    }

    proc build_heat_map {path} {
        variable widget
        ttk::frame $path.top
        ttk::label $path.top.label -text Metric
        ttk::combobox $path.top.metric -textvariable ::espdiff::gui::form(matrix,metric) -state readonly -width 22
        bind $path.top.metric <<ComboboxSelected>> {::espdiff::gui::guard_in matrix ::espdiff::gui::draw_heat_map}
        ttk::checkbutton $path.top.ordered -text "similar variants together" \
            -variable ::espdiff::gui::form(matrix,ordered) \
            -command {::espdiff::gui::guard_in matrix ::espdiff::gui::draw_heat_map}
        button $path.top.plot "Plot row" ::espdiff::gui::plot_row
        button $path.top.table Table... ::espdiff::gui::matrix_table
        tip $path.top.ordered "Order by clustering instead of the list"
        tip $path.top.plot "Plot the chosen row's variant against all others in VMD's plot window"
        tip $path.top.table "Summary of the matrix"
        pack $path.top.label $path.top.metric $path.top.ordered -side left -padx {0 6}
        pack $path.top.table $path.top.plot -side right -padx {6 0}
        canvas $path.map -width 420 -height 212 -background white -highlightthickness 1 -takefocus 1 \
            -highlightbackground gray80 -highlightcolor #3060c0
        ttk::label $path.pair -anchor w -text "A click on a cell compares and draws its pair."
        pack $path.top -fill x
        pack $path.pair -side bottom -fill x
        pack $path.map -fill both -expand 1 -pady 4
        bind $path.map <Configure> {::espdiff::gui::guard_in matrix ::espdiff::gui::draw_heat_map}
        bind $path.map <Motion> {::espdiff::gui::guard_in matrix ::espdiff::gui::point_at %x %y}
        bind $path.map <ButtonPress-1> {::espdiff::gui::guard_in matrix ::espdiff::gui::open_pair_at %x %y}
        foreach {key row column} {Left 0 -1 Right 0 1 Up -1 0 Down 1 0} {
            bind $path.map <$key> [list ::espdiff::gui::guard_in matrix ::espdiff::gui::move_cell $row $column]
        }
        bind $path.map <space> {::espdiff::gui::guard_in matrix ::espdiff::gui::open_chosen_pair; break}
        set widget(matrix,map) $path.map
        set widget(matrix,pair) $path.pair
        foreach name {metric ordered plot table} { set widget(matrix,$name) $path.top.$name }
        show_matrix_running
    }

    proc compute_matrix {} { guard_in matrix ::espdiff::gui::start_matrix }

    proc start_matrix {} {
        variable form
        variable matrix_running
        variable matrix_pairs
        variable matrix_run
        variable variants
        if {$matrix_running ne ""} return
        set output [string trim $form(matrix,output)]
        if {$output eq ""} { error "Results: no name is given" }
        set template [string trim $form(matrix,template)]
        set options [list -output $output -resume $form(matrix,resume)]
        set results [list $output.csv $output.json $output.state]
        if {$template ne ""} {
            lappend options -template $template
            lappend results $output.h5
        }
        if {!$form(matrix,resume) && [llength [glob -nocomplain {*}$results]] > 0} {
            if {![confirm_overwrite $output]} return
            lappend options -overwrite 1
        }
        set settings [setting_options variants]
        tell_in matrix ""
        set ::espdiff::gui::matrix_begun [clock milliseconds]
        set matrix_running [espdiff matrix [matrix_variants] {*}$options {*}$settings \
            -progress ::espdiff::gui::matrix_progress -command ::espdiff::gui::finish_matrix]
        set endpoints {}
        foreach variant $variants { lappend endpoints [variant_endpoint $variant] }
        set matrix_pairs [list $endpoints $settings]
        set matrix_run [dict create variants [matrix_variants] output [file normalize $output] settings $settings \
            template $template]
        remember_molecules matrix $endpoints
        save_settings
        show_matrix_running
    }

    proc confirm_overwrite {output} {
        variable window
        set answer [tk_messageBox -parent $window -type yesno -icon question -title "Surface Potential Comparison" \
            -message "Results named '[file tail $output]' exist." -detail "Replace them?"]
        expr {$answer eq "yes"}
    }

    proc cancel_matrix {} {
        variable matrix_running
        cancel_run $matrix_running
    }

    proc show_matrix_running {} {
        variable widget
        variable variants
        variable matrix_running
        variable matrix_shown
        variable matrix_run
        if {![info exists widget(matrix,plot)] || ![winfo exists $widget(matrix,plot)]} return
        set_enabled [expr {$matrix_running eq "" && [llength $variants] > 1}] $widget(matrix,compute)
        set_enabled [expr {$matrix_running ne ""}] $widget(matrix,cancel)
        set_enabled [expr {$matrix_run ne ""}] $widget(matrix,script)
        set_enabled [expr {$matrix_shown ne ""}] $widget(matrix,metric) $widget(matrix,ordered) $widget(matrix,table)
        set_enabled [expr {$matrix_shown ne "" && [in_vmd]}] $widget(matrix,plot)
        if {$matrix_running eq ""} { $widget(matrix,bar) configure -value 0 }
    }

    proc matrix_progress {stage fraction} {
        variable matrix_begun
        show_progress_in matrix $stage[time_left $matrix_begun $fraction] $fraction
    }

    proc finish_matrix {handle} {
        variable matrix_running
        if {$handle ne $matrix_running} return
        set matrix_running ""
        show_matrix_running
        if {[catch_labelled { espdiff wait $handle } message options]} {
            espdiff delete $handle
            tell_in matrix $message error
            return
        }
        guard_in matrix ::espdiff::gui::show_matrix $handle
    }

    proc show_matrix {handle} {
        variable matrix_shown
        variable matrix_result
        variable widget
        variable form
        if {$matrix_shown ne "" && $matrix_shown in [espdiff handles]} { espdiff delete $matrix_shown }
        set matrix_shown $handle
        set matrix_result [espdiff result $handle]
        set names {}
        dict for {name metric} [dict get $matrix_result metrics] {
            if {[lsearch -not -exact [concat {*}[dict get $metric values]] ""] >= 0} {
                lappend names [dict get $metric title]
            }
        }
        $widget(matrix,metric) configure -values $names
        set usual [dict get $matrix_result metrics [dict get $matrix_result clustering metric] title]
        if {$form(matrix,metric) ni $names} { set form(matrix,metric) $usual }
        set n_bad [llength [dict get $matrix_result not_trustworthy]]
        tell_in matrix "[dict get $matrix_result pairs] pairs in [format %.0f [dict get $matrix_result seconds]] s,\
            [expr {[dict get $matrix_result pairs] - $n_bad}] trustworthy. Written:\
            [join [lmap_tails [dict get $matrix_result files]] {, }]"
        show_matrix_running
        draw_heat_map
    }

    proc lmap_tails {paths} {
        set tails {}
        foreach path $paths { lappend tails [file tail $path] }
        return $tails
    }

    proc matrix_labels {} {
        variable matrix_result
        set labels {}
        foreach variant [dict get $matrix_result variants] { lappend labels [dict get $variant label] }
        return $labels
    }

    # The variants' numbers from left to right.
    proc matrix_order {} {
        variable matrix_result
        variable form
        set labels [matrix_labels]
        set order {}
        foreach label [expr {$form(matrix,ordered) ? [dict get $matrix_result clustering order] : $labels}] {
            lappend order [lsearch -exact $labels $label]
        }
        return $order
    }

    # Name and description of the chosen metric.
    proc chosen_metric {} {
        variable matrix_result
        variable form
        dict for {name metric} [dict get $matrix_result metrics] {
            if {[dict get $metric title] eq $form(matrix,metric)} { return [list $name $metric] }
        }
    }

    proc matrix_table {} {
        variable matrix_shown
        text_window matrix_table "espdiff: $matrix_shown" [espdiff table $matrix_shown]
    }

    # The tab's window closes: cancel its computation.
    proc abandon_matrix {} {
        variable matrix_running
        set handle $matrix_running
        set matrix_running ""
        if {$handle ne "" && $handle in [espdiff handles]} { espdiff delete $handle }
    }
}
