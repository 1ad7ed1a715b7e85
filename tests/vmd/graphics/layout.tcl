# layout.tcl: the window's layout comes to rest in VMD, whatever its texts are: otherwise VMD would never leave Tk's idle tasks.
source [file join $env(ESPDIFF_TESTS) support.tcl]
source [file join $env(ESPDIFF_TESTS) window_support.tcl]
package require espdiff

set folder series19_ubq_2k39
set mol [mol new [input $folder/m00.pqr] type pqr waitfor all]
foreach i {1 2 3} { mol addfile [input $folder/m0$i.pqr] type pqr waitfor all $mol }
set window [espdiff gui]
update

# More calls between two updates than any layout needs are an endless loop; it is cut, so that the test ends.
set fits 0
proc count_fits {args} {
    if {[incr ::fits] > 300} { rename ::espdiff::gui::fit_page ""; proc ::espdiff::gui::fit_page {path} {} }
}
trace add execution ::espdiff::gui::fit_page enter count_fits
proc settled {what} {
    set ::fits 0
    update
    if {$::fits > 300} { error "$what: idle tasks do not end" }
}

test "frames of ubiquitin, settings opened and closed, an error: as it froze" {
    form source,frame 3 target,frame 0
    press compare
    wait_until {$::espdiff::gui::running eq ""}
    check "reasons" {[string length [[widget reasons] cget -text]] > 100}
    foreach n {1 2} { [widget settings_toggle] invoke; settled "settings, click $n" }
    form source,frame foo
    [widget compare] invoke
    settled "an error"
    check "said: [message_line]" {[string match "source: frame 'foo'*" [message_line]]}
}

test "each tab at five sizes, with short and long texts, settings open and closed" {
    # The reasons of a window that is too small for them.
    set long [lrepeat 8 [string repeat "12 % of the area slipped by more than 3 A from its atoms; " 3]]
    foreach size {"" 690x500 700x620 800x700 900x760} {
        wm geometry $window [expr {$size eq "" ? "" : "$size+0+0"}]
        foreach name {residues trajectory matrix ensemble pair} {
            tab $name
            foreach text [list "" [join $long]] {
                if {$name eq "pair"} { ::espdiff::gui::show_message $text } else { ::espdiff::gui::tell_in $name $text }
                settled "$size, $name, a text of [string length $text] letters"
            }
        }
        foreach reasons [list {} [lrange $long 0 3] $long {}] {
            ::espdiff::gui::say_verdict "Not trustworthy" $reasons white black
            foreach open {1 0} {
                [widget settings_toggle] invoke
                settled "$size, [llength $reasons] reasons, settings $open"
            }
        }
    }
}

test "a message does not move the window" {
    wm geometry $window ""
    ::espdiff::gui::show_results
    ::espdiff::gui::show_message ""
    settled "as it was"
    set before [wm geometry $window]
    foreach text {"short" "two lines of text, as the message of a mistake is that names the field, what was found there and what to do"} {
        ::espdiff::gui::show_message $text error
        settled $text
        check_equal "after '$text'" [wm geometry $window] $before
    }
}

test "nor does one of the other tabs" {
    foreach name {trajectory matrix ensemble} {
        tab $name
        ::espdiff::gui::tell_in $name ""
        settled $name
        set before [wm geometry $window]
        ::espdiff::gui::tell_in $name [string repeat "a message of two lines and more " 8]
        settled "$name, a message"
        check_equal $name [wm geometry $window] $before
    }
    tab pair
}

test "after a deletion both sides say what is automatic" {
    set other [mol new [input $folder/m01.pqr] type pqr waitfor all]
    wait_until {[llength [[widget target,mol] cget -values]] == 2}
    form target,mol "$other: m01.pqr"
    ::espdiff::gui::update_endpoint target
    mol delete $other
    wait_until {[llength [[widget target,mol] cget -values]] == 1}
    foreach side {source target} {
        check_equal "$side's molecule" $::espdiff::gui::form($side,mol) "$mol: m00.pqr"
        check "$side's choice" {[string match "Poisson-Boltzmann: *" [[widget $side,choice] cget -text]]}
    }
}

test "no callback failed" { check_equal errors $background {} }

espdiff delete all
finish
