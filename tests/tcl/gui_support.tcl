# gui_support.tcl: what the tests of the window share: its widgets by name, events until something holds, errors in callbacks.

# No test may leave an error in a callback: Tk would show a dialog with a traceback.
set background {}
proc background_error {message options} { lappend ::background [dict get $options -errorinfo] }
interp bgerror {} background_error

proc widget {name} { return $::espdiff::gui::widget($name) }
proc form {args} { array set ::espdiff::gui::form $args }
proc enabled {name} { [widget $name] instate !disabled }
proc pause {ms} { after $ms {set ::paused 1}; vwait ::paused }

# Serves events until `condition` holds, at most so many seconds.
proc until {condition {seconds 300}} {
    set end [expr {[clock seconds] + $seconds}]
    while {![uplevel #0 [list expr $condition]]} {
        if {[clock seconds] > $end} { error "'$condition' did not come true" }
        pause 20
    }
}

# The widgets that the Tab key goes to from one of them, as names of `widget`; those that it does not know are left out.
proc tab_order {first} {
    set names [dict create]
    foreach {name path} [array get ::espdiff::gui::widget] { dict set names $path $name }
    set path [widget $first]
    set order {}
    for {set i 0} {$i < 100} {incr i} {
        if {[dict exists $names $path]} { lappend order [dict get $names $path] }
        set path [tk_focusNext $path]
        if {$path eq [widget $first]} break
    }
    return $order
}

# `after` scripts of ours; Tk has some of its own.
proc our_afters {} {
    set ours {}
    foreach id [after info] { if {[string match *espdiff* [after info $id]]} { lappend ours [after info $id] } }
    return $ours
}
