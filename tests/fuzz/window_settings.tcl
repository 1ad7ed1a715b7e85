# window_settings.tcl: the window's settings file, mutated blindly: window_settings.tcl RUNS SECONDS (0: no limit).
# Each text is taken whole or refused by a message of ours, changes nothing but known fields, and runs nothing.
lassign $argv runs seconds
lappend auto_path $env(ESPDIFF_TCL_PACKAGE)
package require espdiff
set repository [file normalize [file join [file dirname [info script]] .. ..]]
source [file join $repository tcl gui remembered.tcl]

namespace eval ::espdiff::gui {
    variable standard
    foreach row [::espdiff::core::settings] { set standard([dict get $row name]) [dict get $row default] }
}
# What a text could run shows here.
set executed 0
proc trap {args} { incr ::executed }
proc exec {args} { incr ::executed }
proc open {args} { incr ::executed }

set words [concat [dict keys $::espdiff::gui::remembered] [array names ::espdiff::gui::standard] {
    form setting \{ \} [ ] \" \\ $ ; nan inf -1 0 1 1e999 4294967297 {[trap]} {$trap} {;trap} "\n" "\r" "\t" " " {{}} "\\\n" "\u0000"
    "# espdiff: settings of the window, version 1" sign fade single auto given {0 1} {{a b} c} "\uFFFE" "\U0001F600"
}]
proc below {n} { expr {int(rand() * $n)} }
proc mutated {text} {
    global words
    for {set n [expr {1 + [below 4]}]} {$n > 0} {incr n -1} {
        set at [below [expr {[string length $text] + 1}]]
        switch [below 5] {
            0 { set text [string replace $text $at $at [format %c [below 256]]] }
            1 { set text [string replace $text $at [expr {$at + [below 8]}]] }
            2 { set text [string replace $text $at $at "[string index $text $at][lindex $words [below [llength $words]]]"] }
            3 { set text [string replace $text $at $at "[string range $text [below $at] $at]"] }
            4 { set text [string range $text 0 $at] }
        }
    }
    return $text
}

set head $::espdiff::gui::remembered_head
set rows [list $head]
foreach {name kind} $::espdiff::gui::remembered { lappend rows [list form $name [lindex $kind 0]] }
foreach {name value} [array get ::espdiff::gui::standard] { lappend rows [list setting $name $value] }
set seeds [list "[join $rows \n]\n" "$head\nform draw,color sign\nsetting grid-spacing 0.8\n" "$head\nform draw,legend 0\n"]

set known "^(its first line is not '|line \[0-9\]+ is damaged$|line \[0-9\]+: ')"
expr {srand(20)}
set start [clock seconds]
for {set n 0; set taken 0} {($runs == 0 || $n < $runs) && ($seconds == 0 || [clock seconds] - $start < $seconds)} {incr n} {
    set text [mutated [lindex $seeds [below 3]]]
    if {[catch { ::espdiff::gui::parse_settings $text } answer]} {
        if {![regexp $known $answer]} { puts "foreign message: $answer\nof the text: [list $text]"; exit 1 }
    } else {
        incr taken
        foreach {array name value} $answer {
            if {$array eq "form" ? ![dict exists $::espdiff::gui::remembered $name] : ![info exists ::espdiff::gui::standard($name)]} {
                puts "a field that is none: $name\nof the text: [list $text]"
                exit 1
            }
        }
    }
    if {$executed} { puts "something ran\nof the text: [list $text]"; exit 1 }
}
puts "taken $taken\nstat::number_of_executed_units: $n"
