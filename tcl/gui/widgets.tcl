# widgets.tcl: helpers shared by the window's parts: tips, keys, texts, guarded commands, formatted numbers.

namespace eval ::espdiff::gui {
    variable tips       ;# help by widget
    variable tip_id ""  ;# the `after` script that shows a tip
    array set tips {}

    variable error_shown  ;# by tab whose message line shows an error: the error's number
    array set error_shown {}
    variable n_errors 0

    # Evaluates a command and shows its error in the window instead of a traceback dialog.
    proc guard {args} { guarded pair $args }

    # Like guard, for actions in a tab.
    proc guard_in {tab args} { guarded $tab $args }

    # An older error disappears when the user does something else that succeeds. Mere updates of the window leave it.
    proc guarded {tab command} {
        variable error_shown
        set stood [expr {[info exists error_shown($tab)] ? $error_shown($tab) : 0}]
        if {[catch_labelled { uplevel #0 $command } message options]} {
            if {$tab eq "pair"} { show_message $message error } else { tell_in $tab $message error }
        } elseif {$stood && [info exists error_shown($tab)] && $error_shown($tab) == $stood
            && ![regexp {^::espdiff::gui::(update|tell|draw|take|finish|list)_} [lindex $command 0]]} {
            clear_error $tab
        }
    }

    # Removes an error; a later message stays.
    proc clear_error {tab} {
        variable error_shown
        if {![info exists error_shown($tab)]} return
        if {$tab eq "pair"} { show_message "" } else { tell_in $tab "" }
    }

    # A label whose text wraps at the width that it is given. It asks for no width of its own (one letter), so that no
    # width follows from how the text wraps: otherwise its page could widen and narrow for ever, and Tk's idle tasks
    # would never end.
    proc wrapping_label {path args} {
        ttk::label $path -anchor w -justify left -width 1 -wraplength 100 {*}$args
        bind $path <Configure> {%W configure -wraplength [expr {max(100, %w - 4)}]}
        return $path
    }

    # The tab that a widget is in.
    proc tab_of {path} { expr {[regexp {\.tabs\.(\w+)} $path -> tab] ? $tab : "pair"} }

    # A button with a guarded command, whose error appears in its own tab. An underlined letter is also its Alt key.
    proc button {path text command {underline -1}} {
        variable window
        ttk::button $path -text $text -command [concat ::espdiff::gui::guard_in [tab_of $path] $command] \
            -underline $underline -width 0
        if {$underline >= 0} {
            bind $window <Alt-[string tolower [string index $text $underline]]> "focus $path; $path invoke; break"
        }
        return $path
    }

    # Presses a button, if it is enabled.
    proc press {name} {
        variable widget
        if {[info exists widget($name)] && [winfo exists $widget($name)]} { $widget($name) invoke }
    }

    proc set_enabled {enabled args} {
        foreach path $args { $path state [expr {$enabled ? "!disabled" : "disabled"}] }
    }

    # Shows a text when the mouse rests on a widget.
    proc tip {path text} {
        variable tips
        set tips($path) $text
        # Tk focuses any widget with key bindings.
        if {[winfo class $path] eq "TLabel"} { $path configure -takefocus 0 }
        bind $path <Enter> {+::espdiff::gui::tip_later %W}
        foreach event {<Leave> <ButtonPress> <KeyPress>} { bind $path $event {+::espdiff::gui::hide_tip} }
        return $path
    }

    proc tip_later {path} {
        variable tip_id
        after cancel $tip_id
        set tip_id [after 600 [list ::espdiff::gui::show_tip $path]]
    }

    proc show_tip {path} {
        variable window
        variable tips
        hide_tip
        if {![winfo exists $path] || $tips($path) eq ""} return
        toplevel $window.tip
        wm overrideredirect $window.tip 1
        pack [ttk::label $window.tip.text -text $tips($path) -wraplength 240p -padding 3p -background #ffffe0 \
            -foreground black -relief solid -borderwidth 1]
        set x [expr {min([winfo rootx $path], [winfo screenwidth $path] - [winfo reqwidth $window.tip.text] - 4)}]
        set y [expr {[winfo rooty $path] + [winfo height $path] + 3}]
        if {$y + [winfo reqheight $window.tip.text] > [winfo screenheight $path]} {
            set y [expr {[winfo rooty $path] - [winfo reqheight $window.tip.text] - 3}]
        }
        wm geometry $window.tip +$x+$y
    }

    proc hide_tip {} {
        variable window
        variable tip_id
        after cancel $tip_id
        destroy $window.tip
    }

    proc forget_tips {} {
        variable tips
        variable tip_id
        after cancel $tip_id
        array unset tips
    }

    # A labelled row of a form: label in `column`, widget to its right, both with the same tip.
    proc form_row {parent row label path help {column 0}} {
        set name [ttk::label $parent.label_[string map {. _} [winfo name $path]] -text $label]
        grid $name -row $row -column $column -sticky w -padx {0 6} -pady 2
        grid $path -row $row -column [expr {$column + 1}] -sticky ew -pady 2
        tip $name $help
        tip $path $help
        return $name
    }

    # A window with a text to read and copy.
    proc text_window {name title text {fixed 1}} {
        variable window
        set top $window.$name
        if {![winfo exists $top]} {
            toplevel $top
            set outer [ttk::frame $top.outer -padding 8]
            text $top.outer.text -wrap [expr {$fixed ? "none" : "word"}] -width [expr {$fixed ? 100 : 74}] -height 28 \
                -font [expr {$fixed ? "TkFixedFont" : "TkDefaultFont"}] -yscrollcommand [list $outer.y set] \
                -xscrollcommand [list $outer.x set] -padx 6 -pady 6 -background white -foreground black
            ttk::scrollbar $outer.y -orient vertical -command [list $outer.text yview]
            ttk::scrollbar $outer.x -orient horizontal -command [list $outer.text xview]
            ttk::frame $outer.buttons
            ttk::button $outer.buttons.copy -text Copy -underline 0 \
                -command [list ::espdiff::gui::copy_text $outer.text]
            ttk::button $outer.buttons.save -text Save... -underline 0 \
                -command [list ::espdiff::gui::guard ::espdiff::gui::save_text $outer.text $name]
            ttk::button $outer.buttons.close -text Close -command [list destroy $top]
            pack $outer.buttons.close $outer.buttons.save $outer.buttons.copy -side right -padx {6 0}
            grid $outer.text $outer.y -sticky news
            if {$fixed} { grid $outer.x -sticky ew }
            grid $outer.buttons -columnspan 2 -sticky ew -pady {8 0}
            grid columnconfigure $outer 0 -weight 1
            grid rowconfigure $outer 0 -weight 1
            pack $outer -fill both -expand 1
            bind $top <Escape> [list destroy $top]
            bind $top <Alt-c> [list $outer.buttons.copy invoke]
            bind $top <Alt-s> [list $outer.buttons.save invoke]
        }
        wm title $top $title
        set shown $top.outer.text
        set height [expr {$fixed ? max(6, min(36, [llength [split $text \n]] + 1)) : 25}]
        $shown configure -state normal -height $height
        $shown delete 1.0 end
        $shown insert end $text
        $shown configure -state disabled
        raise $top
        focus $shown
        return $top
    }

    proc copy_text {path} {
        clipboard clear -displayof $path
        clipboard append -displayof $path [string trimright [$path get 1.0 end]]\n
    }

    # Saves a script unchanged; other texts are for reading.
    proc save_text {path name} {
        set ending [expr {$name eq "script" ? ".tcl" : ".txt"}]
        set file [tk_getSaveFile -parent [winfo toplevel $path] -initialfile espdiff$ending -defaultextension $ending]
        if {$file ne ""} { write_whole_file $file [string trimright [$path get 1.0 end]]\n }
    }

    # Four significant digits and the unit; a dash if there is no value.
    proc with_unit {value {unit ""}} {
        if {$value eq ""} { return "\u2013" }
        set text [expr {abs($value) >= 1000 && abs($value) < 1e7 ? [format %.0f $value] : [format %.4g $value]}]
        # Rounding noise.
        if {abs($value) < 1e-9} { set text 0 }
        if {$unit eq ""} { return $text }
        return "$text $unit"
    }

    # ", about 2 min left" from when a run began (clock milliseconds) and the fraction done; empty while it is too early
    # to tell.
    proc time_left {begun fraction} {
        set elapsed [expr {([clock milliseconds] - $begun) / 1000.0}]
        if {$elapsed < 5 || $fraction < 0.05 || $fraction >= 1} { return "" }
        set left [expr {$elapsed * (1 - $fraction) / $fraction}]
        if {$left < 5} { return "" }
        if {$left < 90} { return ", about [expr {round($left)}] s left" }
        if {$left < 5400} { return ", about [expr {round($left / 60)}] min left" }
        return ", about [format %.1f [expr {$left / 3600}]] h left"
    }

    # A width that holds a text in letters of the usual size, for the letters of this screen.
    proc scaled {pixels} { expr {round($pixels * max(1.0, [font metrics TkDefaultFont -linespace] / 17.0))} }

    proc bold_font {} {
        if {"EspdiffBold" ni [font names]} { font create EspdiffBold {*}[font actual TkDefaultFont] -weight bold }
        return EspdiffBold
    }

    # A tab's start and cancel buttons, progress and message: widget(TAB,...) with the names START, cancel, bar, script
    # and message.
    proc build_tab_bar {tab path start title start_command cancel_command start_tip cancel_tip} {
        variable widget
        ttk::frame $path
        button $path.$start $title $start_command
        button $path.cancel Stop $cancel_command
        ttk::progressbar $path.bar -maximum 1.0 -length 60
        button $path.script Script... ::espdiff::gui::show_script
        wrapping_label $path.message
        tip $path.$start $start_tip
        tip $path.cancel $cancel_tip
        tip $path.script "The Tcl commands that repeat this"
        grid $path.$start $path.cancel $path.bar $path.script -sticky ew -padx {0 6}
        grid configure $path.script -padx 0
        grid $path.message -columnspan 4 -sticky new -pady {4 0}
        # Room for three lines, so that the window does not move with each message.
        grid rowconfigure $path 1 -minsize [expr {3 * [font metrics TkDefaultFont -linespace] + 4}]
        grid columnconfigure $path 2 -weight 1
        foreach name [list $start cancel bar script message] { set widget($tab,$name) $path.$name }
    }

    # A tab's line of text; errors also go to VMD's console, so that they are not lost with the tab.
    proc tell_in {tab text {kind note}} {
        variable widget
        variable error_shown
        unset -nocomplain error_shown($tab)
        if {$kind eq "error"} { tell_console $text; set error_shown($tab) [incr ::espdiff::gui::n_errors] }
        if {![info exists widget($tab,message)] || ![winfo exists $widget($tab,message)]} return
        $widget($tab,message) configure -text $text -foreground [expr {$kind eq "error" ? "#b00020" : "black"}]
    }

    # A tab's bar and line of text while it runs.
    proc show_progress_in {tab text fraction} {
        variable widget
        if {![info exists widget($tab,bar)] || ![winfo exists $widget($tab,bar)]} return
        $widget($tab,bar) configure -value $fraction
        tell_in $tab $text
    }

    # Ends a tab's run; `running` is its handle, empty for none.
    proc cancel_run {running} { if {$running ne ""} { espdiff cancel $running } }

    # Replaces the rows of a tab's list, numbered from 0; the command `cells` makes a row's values.
    proc fill_list {tab rows cells} {
        variable widget
        $widget($tab,list) delete [$widget($tab,list) children {}]
        set number 0
        foreach row $rows {
            $widget($tab,list) insert {} end -id $number -values [$cells $row]
            incr number
        }
    }

    # Refuses a selection that VMD does not understand, or that holds no atoms, before it is in a tab's list.
    proc check_selection {mol frame text} { ::espdiff::vmd_structure [list mol $mol frame $frame sel $text] Atoms }

    # Offers VMD's molecules to a tab that adds some to its list, and says whether a row can be removed.
    proc update_list {tab} {
        variable form
        variable widget
        if {[in_vmd]} {
            set names [molecule_names]
            $widget($tab,mol) configure -values $names
            if {$form($tab,mol) ni $names} { set form($tab,mol) [lindex $names 0] }
            set_enabled [expr {[llength $names] > 0}] $widget($tab,add)
        }
        set_enabled [expr {[llength [$widget($tab,list) selection]] > 0}] $widget($tab,remove)
    }
}
