# window_support.tcl: what the tests of the window in VMD share: its widgets by name, events until something holds.

proc widget {name} { return $::espdiff::gui::widget($name) }
proc form {args} { array set ::espdiff::gui::form $args }
proc press {name} { update; [widget $name] invoke; update }
proc pause {ms} { after $ms {set ::tick 1}; vwait ::tick }
proc wait_until {condition} {
    set end [expr {[clock seconds] + 120}]
    while {![uplevel #0 [list expr $condition]]} {
        if {[clock seconds] > $end} { error "'$condition' did not come true" }
        pause 30
    }
}
proc message_line {} { string trim [[widget message] get 1.0 end] }
proc tab {name} { ::espdiff::gui::show_tab $name; update }

# Callbacks whose errors nobody would see.
set background {}
proc background_error {message options} { lappend ::background $message }
interp bgerror {} background_error

# TIM's two states with their maps, as molecules `source` and `target`.
proc load_tim {} {
    foreach {name side} {scTIM_chainA source dTIM_chainA target} {
        set ::$side [mol new [input pair_tim_maps/$name.pqr] type pqr waitfor all]
        mol addfile [input pair_tim_maps/${name}_pot-PE0.dx] type dx waitfor all [set ::$side]
    }
}

# Answers the window's questions with yes.
proc with_yes {body} {
    rename tk_messageBox tk_box
    proc tk_messageBox {args} { return yes }
    set code [catch { uplevel 1 $body } message options]
    rename tk_messageBox ""
    rename tk_box tk_messageBox
    return -options $options $message
}
