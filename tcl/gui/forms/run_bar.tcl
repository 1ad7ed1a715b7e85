# run_bar.tcl: starts and cancels a comparison, and shows its progress and messages.

namespace eval ::espdiff::gui {
    variable running ""   ;# handle of this window's running computation
    variable run_begun 0  ;# clock milliseconds
    variable asking_tab ""  ;# the tab, other than Pair, that asked for the running comparison
    variable watch_id ""  ;# the `after` script that notices its deletion

    # Stages in order: name, text, start and end on the bar. The surfaces' stages come twice; the bar does not go back.
    variable stages {
        "" Waiting 0 0
        read "Reading" 0 2
        align "Superposing" 2 2
        potential "Computing the potentials" 2 4
        surface "Building the surfaces" 4 8
        regularize "Regularizing the triangles" 8 25
        morph "Mapping source onto target" 25 60
        deform "Mapping source onto target" 25 70
        "second morph" "Mapping again by local motions" 60 85
        certificate "Checking the mapping" 60 96
        metrics "Comparing" 96 100
    }

    proc build_run_bar {path} {
        variable widget
        ttk::frame $path -padding {8 6 8 8}
        button $path.compare Compare ::espdiff::gui::compare 0
        button $path.cancel Cancel ::espdiff::gui::cancel 2
        button $path.swap Swap ::espdiff::gui::swap_sides 1
        ttk::progressbar $path.bar -maximum 100 -length 60
        button $path.script Script... ::espdiff::gui::show_script 2
        button $path.help Help ::espdiff::gui::show_help 0
        tip $path.compare "Map the source onto the target and compare them (Return)"
        tip $path.cancel "Cancel the computation (Escape)"
        tip $path.swap "Exchange source and target: the other direction is another mapping"
        tip $path.script "The Tcl commands that repeat this"
        text $path.message -height 2 -width 20 -wrap word -relief flat -borderwidth 0 -highlightthickness 0 \
            -font TkDefaultFont -background [ttk::style lookup TFrame -background] -takefocus 0 -cursor xterm
        $path.message tag configure error -foreground #b00020
        $path.message configure -state disabled
        bind $path.message <Configure> ::espdiff::gui::fit_message
        bind $path.message <ButtonPress-1> {focus %W}
        set buttons [list $path.compare $path.cancel $path.swap]
        # Beside Compare, so that a small screen has it without scrolling to the page's end.
        if {[in_vmd]} {
            lappend buttons [button $path.draw Draw ::espdiff::gui::draw 0]
            tip $path.draw "Draw the surface in VMD's window, as chosen under Draw"
            set widget(draw) $path.draw
        }
        grid {*}$buttons $path.bar $path.script $path.help -sticky ew -padx {0 6}
        grid configure $path.help -padx 0
        grid columnconfigure $path [llength $buttons] -weight 1
        grid $path.message -columnspan [expr {[llength $buttons] + 3}] -sticky ew -pady {2 0}
        foreach name {compare cancel swap bar script message} { set widget($name) $path.$name }
        $path.compare configure -default active
        set_enabled 0 $path.cancel
        show_message ""
    }

    # One line or several, selectable; errors are red and also go to the console.
    proc show_message {text {kind note}} {
        variable widget
        variable error_shown
        unset -nocomplain error_shown(pair)
        if {$kind eq "error"} { tell_console $text; set error_shown(pair) [incr ::espdiff::gui::n_errors] }
        if {![info exists widget(message)] || ![winfo exists $widget(message)]} return
        $widget(message) configure -state normal
        $widget(message) delete 1.0 end
        $widget(message) insert end $text $kind
        $widget(message) configure -state disabled
        fit_message
    }

    proc tell_console {text} {
        if {[info commands ::vmdcon] ne ""} { vmdcon -err "espdiff) $text" } else { puts stderr "espdiff: $text" }
    }

    # Two lines, so that the window does not move with each message; more for a longer one, up to a limit; the wheel
    # shows the rest.
    proc fit_message {} {
        variable widget
        if {![info exists widget(message)]} return
        set lines [$widget(message) count -update -displaylines 1.0 end]
        if {[string is integer -strict $lines]} { $widget(message) configure -height [expr {max(2, min(6, $lines))}] }
    }

    proc compare {} {
        variable running
        if {$running ne ""} return
        show_message ""
        if {[offer_preparation]} return
        set source [endpoint source]
        set target [endpoint target]
        if {![catch { start_compare $source $target [setting_options] } message options]} return
        if {![offer_whole $message]} { return -options $options $message }
        foreach side {source target} {
            if {[dict exists [set $side] mol]} { lappend $side whole 1 }
        }
        start_compare $source $target [setting_options]
    }

    # A molecule that its periodic cell cuts: asks whether to put it together.
    proc offer_whole {message} {
        variable window
        if {![string match "*is cut by its periodic cell*" $message]} { return 0 }
        set answer [tk_messageBox -parent $window -type yesno -icon question -title "Surface Potential Comparison" \
            -message "A molecule is cut by its periodic cell." -detail "[lindex [split $message ";"] 0].\n\nMake the\
            molecules whole, and compare them? Their atoms in VMD stay where they are."]
        expr {$answer eq "yes"}
    }

    # Compares in the background; returns the handle.
    proc start_compare {source target settings} {
        variable running
        if {$running ne ""} { error "a comparison is running; wait for it, or cancel it" }
        set running [espdiff compare $source $target {*}$settings \
            -progress ::espdiff::gui::show_progress -command {::espdiff::gui::guard ::espdiff::gui::finish}]
        set ::espdiff::gui::run_begun [clock milliseconds]
        remember_compare $running $source $target $settings
        save_settings
        show_running 1
        watch
        return $running
    }

    proc cancel {} {
        variable running
        if {$running eq ""} return
        show_message "Cancelling..."
        espdiff cancel $running
    }

    # Enables buttons and shows the bar.
    proc show_running {is_running} {
        variable widget
        if {![info exists widget(compare)] || ![winfo exists $widget(compare)]} return
        set_enabled [expr {!$is_running}] $widget(compare) $widget(swap)
        set_enabled $is_running $widget(cancel)
        $widget(bar) configure -value 0
    }

    proc stage_words {stage} {
        variable stages
        foreach {name words begin end} $stages { if {$name eq $stage} { return $words } }
        return $stage
    }

    # Called by espdiff with the stage and the fraction done.
    proc show_progress {stage fraction} {
        variable widget
        variable stages
        variable run_begun
        if {![info exists widget(bar)] || [$widget(cancel) instate disabled]} return
        foreach {name words begin end} $stages {
            if {$name ne $stage} continue
            set share [expr {$begin + $fraction * ($end - $begin)}]
            $widget(bar) configure -value [expr {max($share, [$widget(bar) cget -value])}]
            show_message "$words...[time_left $run_begun [expr {[$widget(bar) cget -value] / 100.0}]]"
        }
    }

    # Called by espdiff at the end of a computation, successful or not.
    proc finish {handle} {
        variable running
        if {$handle ne $running} return
        end_run
        if {[catch_labelled { espdiff wait $handle } message options]} {
            espdiff delete $handle
            forget $handle
            if {[lindex [dict get $options -errorcode] 1] eq "CANCELLED"} {
                show_message "Cancelled."
            } else {
                show_message $message error
                tell_asking_tab $message error
            }
            return
        }
        set text "$handle is done in [format %.1f [expr {[espdiff result $handle time_ms total] / 1000.0}]] s."
        show_message $text
        show_results $handle
        draw_if_wanted $handle
        tell_asking_tab $text
    }

    # The tab Trajectory or Matrix that asked for a pair learns how it ended; it stays open.
    proc tell_asking_tab {text {kind note}} {
        variable asking_tab
        if {$asking_tab ne ""} { tell_in $asking_tab "$text The tab Pair has it." $kind }
        set asking_tab ""
    }

    # Draws a pair opened from a matrix at once.
    proc draw_if_wanted {handle} {
        variable draw_when_done
        set wanted [expr {$draw_when_done eq $handle && [in_vmd]}]
        set draw_when_done ""
        if {!$wanted} return
        espdiff undraw
        draw
    }

    proc end_run {} {
        variable running
        variable watch_id
        after cancel $watch_id
        set running ""
        show_running 0
    }

    # A script can delete any handle; `finish` is then not called.
    proc watch {} {
        variable running
        variable watch_id
        if {$running eq ""} return
        if {$running in [espdiff handles]} {
            set watch_id [after 500 ::espdiff::gui::watch]
            return
        }
        show_message "$running was deleted before it finished."
        forget_preparations
        end_run
    }

    # The window closes: cancel its computation.
    proc abandon_run {} {
        variable running
        set handle $running
        if {$handle eq ""} return
        end_run
        forget_preparations
        forget $handle
        show_message "Cancelled: the window was closed."
        if {$handle in [espdiff handles]} { espdiff delete $handle }
    }
}
