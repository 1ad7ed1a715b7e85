# letters.tcl: texts as triangles, which every renderer of VMD draws in the same size. VMD's own texts have another size in
# each ray tracer, and the width of a line in none.

namespace eval ::espdiff {
    # Strokes of each letter as x y pairs: capitals are 6 high, small letters 4.2, on a baseline at 0.
    variable letters [dict create { } {} \
        0 {{1 0 3 0 4 1 4 5 3 6 1 6 0 5 0 1 1 0}} 1 {{1 4.8 2.2 6 2.2 0}} 2 {{0 5 1 6 3 6 4 5 4 3.8 0 0 4 0}} \
        3 {{0 5.2 1 6 3 6 4 5 4 4 3 3.2 1.6 3.2} {3 3.2 4 2.4 4 1 3 0 1 0 0 0.8}} 4 {{3 0 3 6 0 2 4 2}} \
        5 {{4 6 0.4 6 0.2 3.4 1 3.8 3 3.8 4 2.8 4 1 3 0 1 0 0 0.8}} \
        6 {{3.8 5.4 3 6 1 6 0 5 0 1 1 0 3 0 4 1 4 2.4 3 3.4 1 3.4 0 2.4}} 7 {{0 6 4 6 1.4 0}} \
        8 {{1 3.2 0 4 0 5 1 6 3 6 4 5 4 4 3 3.2 1 3.2 0 2.3 0 1 1 0 3 0 4 1 4 2.3 3 3.2}} \
        9 {{0.2 0.6 1 0 3 0 4 1 4 5 3 6 1 6 0 5 0 3.6 1 2.6 3 2.6 4 3.6}} \
        A {{0 0 2.2 6 4.4 0} {0.8 2.1 3.6 2.1}} \
        B {{0 0 0 6 2.8 6 3.8 5.2 3.8 4 2.8 3.2 0 3.2} {2.8 3.2 4 2.4 4 0.9 3 0 0 0}} \
        C {{4.2 5 3.2 6 1.2 6 0 4.8 0 1.2 1.2 0 3.2 0 4.2 1}} D {{0 0 0 6 2.6 6 4.2 4.6 4.2 1.4 2.6 0 0 0}} \
        E {{3.8 6 0 6 0 0 3.8 0} {0 3.2 3.2 3.2}} F {{3.8 6 0 6 0 0} {0 3.2 3.2 3.2}} \
        G {{4.2 5 3.2 6 1.2 6 0 4.8 0 1.2 1.2 0 3.2 0 4.2 1 4.2 2.8 2.4 2.8}} \
        H {{0 0 0 6} {4.2 0 4.2 6} {0 3.2 4.2 3.2}} I {{0.4 0 0.4 6}} J {{2.8 6 2.8 1 1.8 0 0.9 0 0 0.9}} \
        K {{0 0 0 6} {4 6 0 2.2} {1.4 3.6 4.2 0}} L {{0 6 0 0 3.6 0}} M {{0 0 0 6 2.5 2 5 6 5 0}} \
        N {{0 0 0 6 4.2 0 4.2 6}} O {{1.2 0 3.4 0 4.6 1.2 4.6 4.8 3.4 6 1.2 6 0 4.8 0 1.2 1.2 0}} \
        P {{0 0 0 6 2.8 6 4 5 4 3.8 2.8 2.8 0 2.8}} \
        Q {{1.2 0 3.4 0 4.6 1.2 4.6 4.8 3.4 6 1.2 6 0 4.8 0 1.2 1.2 0} {2.8 1.8 4.8 -0.6}} \
        R {{0 0 0 6 2.8 6 4 5 4 3.8 2.8 2.8 0 2.8} {2.2 2.8 4.2 0}} \
        S {{4 5.1 3 6 1 6 0 5.1 0 4.1 1 3.3 3 2.9 4 2.1 4 0.9 3 0 1 0 0 0.9}} T {{0 6 4.4 6} {2.2 6 2.2 0}} \
        U {{0 6 0 1.2 1.2 0 3 0 4.2 1.2 4.2 6}} V {{0 6 2.2 0 4.4 6}} W {{0 6 1.5 0 3 5 4.5 0 6 6}} \
        X {{0 0 4.2 6} {0 6 4.2 0}} Y {{0 6 2.2 3 4.4 6} {2.2 3 2.2 0}} Z {{0 6 4 6 0 0 4 0}} \
        a {{0.4 3.6 1.2 4.2 2.6 4.2 3.4 3.4 3.4 0} {3.4 2.4 1.2 2.4 0 1.7 0 0.7 0.8 0 2.2 0 3.4 0.9}} \
        b {{0 6.2 0 0} {0 3.2 1 4.2 2.4 4.2 3.4 3.2 3.4 1 2.4 0 1 0 0 1}} \
        c {{3.2 3.4 2.4 4.2 1 4.2 0 3.2 0 1 1 0 2.4 0 3.2 0.8}} \
        d {{3.4 6.2 3.4 0} {3.4 3.2 2.4 4.2 1 4.2 0 3.2 0 1 1 0 2.4 0 3.4 1}} \
        e {{0 2.2 3.4 2.2 3.4 3.2 2.4 4.2 1 4.2 0 3.2 0 1 1 0 2.4 0 3.3 0.8}} \
        f {{2.4 6.2 1.6 6.2 0.9 5.4 0.9 0} {0 4.2 2.2 4.2}} \
        g {{3.4 4.2 3.4 -1 2.4 -1.9 1 -1.9 0.2 -1.3} {3.4 3.2 2.4 4.2 1 4.2 0 3.2 0 1 1 0 2.4 0 3.4 1}} \
        h {{0 6.2 0 0} {0 3.1 1.1 4.2 2.3 4.2 3.2 3.3 3.2 0}} i {{0.4 4.2 0.4 0} {0.4 5.7 0.4 6.1}} \
        j {{1 4.2 1 -1.2 0.4 -1.9 -0.3 -1.9} {1 5.7 1 6.1}} k {{0 6.2 0 0} {3 4.2 0 1.5} {1.1 2.5 3.2 0}} \
        l {{0.4 6.2 0.4 0}} \
        m {{0 4.2 0 0} {0 3.2 0.9 4.2 1.8 4.2 2.6 3.4 2.6 0} {2.6 3.3 3.5 4.2 4.4 4.2 5.2 3.4 5.2 0}} \
        n {{0 4.2 0 0} {0 3.1 1.1 4.2 2.3 4.2 3.2 3.3 3.2 0}} o {{1 0 2.4 0 3.4 1 3.4 3.2 2.4 4.2 1 4.2 0 3.2 0 1 1 0}} \
        p {{0 4.2 0 -1.9} {0 3.2 1 4.2 2.4 4.2 3.4 3.2 3.4 1 2.4 0 1 0 0 1}} \
        q {{3.4 4.2 3.4 -1.9} {3.4 3.2 2.4 4.2 1 4.2 0 3.2 0 1 1 0 2.4 0 3.4 1}} r {{0 4.2 0 0} {0 3 1 4.2 2.2 4.2}} \
        s {{3 3.6 2.2 4.2 0.8 4.2 0 3.5 0 2.9 0.7 2.3 2.4 1.9 3 1.3 3 0.7 2.2 0 0.8 0 0 0.6}} \
        t {{0.9 5.6 0.9 0.8 1.6 0 2.4 0} {0 4.2 2.3 4.2}} u {{0 4.2 0 0.9 0.9 0 2.1 0 3.2 1.1} {3.2 4.2 3.2 0}} \
        v {{0 4.2 1.7 0 3.4 4.2}} w {{0 4.2 1.2 0 2.5 3.6 3.8 0 5 4.2}} x {{0 0 3.2 4.2} {0 4.2 3.2 0}} \
        y {{0 4.2 1.7 0} {3.4 4.2 1.2 -1.3 0.6 -1.9 0 -1.9}} z {{0 4.2 3 4.2 0 0 3 0}} \
        . {{0.4 0 0.4 0.5}} , {{0.7 0.5 0.7 0 0.2 -1}} : {{0.4 0 0.4 0.5} {0.4 3.4 0.4 3.9}} \
        {;} {{0.7 0.5 0.7 0 0.2 -1} {0.7 3.4 0.7 3.9}} - {{0 2.4 2.6 2.4}} + {{0 2.6 3.6 2.6} {1.8 0.8 1.8 4.4}} \
        = {{0 3.4 3.4 3.4} {0 1.8 3.4 1.8}} _ {{0 -1 4 -1}} / {{0 -0.6 2.8 6.4}} \\ {{0 6.4 2.8 -0.6}} \
        ( {{1.4 6.8 0.4 5.2 0 3 0.4 0.6 1.4 -1}} ) {{0 6.8 1 5.2 1.4 3 1 0.6 0 -1}} \
        \[ {{1.4 6.8 0 6.8 0 -1 1.4 -1}} \] {{0 6.8 1.4 6.8 1.4 -1 0 -1}} < {{3.4 4.8 0 2.6 3.4 0.4}} \
        > {{0 4.8 3.4 2.6 0 0.4}} \
        % {{0.4 0 4.4 6} {0.4 3.8 1.4 3.8 1.8 4.4 1.8 5.4 1.4 6 0.4 6 0 5.4 0 4.4 0.4 3.8}
            {3.4 0 4.4 0 4.8 0.6 4.8 1.6 4.4 2.2 3.4 2.2 3 1.6 3 0.6 3.4 0}} \
        # {{1.2 0 1.8 6} {3 0 3.6 6} {0.2 2 4.2 2} {0.4 4 4.4 4}} * {{1.5 5.8 1.5 2.8} {0.2 5 2.8 3.6} {0.2 3.6 2.8 5}} \
        ^ {{0 3.8 1.5 6 3 3.8}} ' {{0.4 6.2 0.4 4.8}} \" {{0.4 6.2 0.4 4.8} {1.8 6.2 1.8 4.8}} | {{0.4 6.8 0.4 -1}} \
        ! {{0.4 6 0.4 1.8} {0.4 0 0.4 0.5}} ? {{0 5.1 0.8 6 2.4 6 3.2 5.1 3.2 4.2 1.6 2.9 1.6 1.8} {1.6 0 1.6 0.5}} \
        & {{4 0 0.8 4.5 0.8 5.3 1.5 6 2.3 6 3 5.3 3 4.5 0.4 2.2 0 1.4 0.6 0.3 1.6 0 2.6 0.3 4 2.2}} \
        @ {{3.4 3.8 2.4 4.3 1.6 3.6 1.6 2.2 2.4 1.5 3.4 2 3.4 4.2} {3.4 2 4.2 1.5 5 2.4 5 4 3.8 5.6 1.8 5.8 0 4 0 1.4 1.4 -0.4
            4 -0.6}} \
        ~ {{0 2.2 0.8 3 1.6 3 2.4 2.2 3.2 2.2 4 3}}]
    variable letter_unit 0.0057  ;# of the strokes' coordinates at size 1, in half heights of the window
    variable stroke_width 0.8    ;# in the strokes' coordinates
    variable letter_gap 1.5
    variable drawn_texts [dict create]  ;# by graphics molecule: its texts

    proc strokes_of {letter} {
        variable letters
        if {$letter eq "\u00c5"} { set letter A }
        if {![dict exists $letters $letter]} { set letter ? }
        return [dict get $letters $letter]
    }

    # In the strokes' coordinates, with the gap behind it. Digits are of one width, a blank has its own.
    proc letter_advance {letter} {
        variable letter_gap
        if {$letter eq " "} { return 3.2 }
        if {[string is digit $letter]} { return [expr {4 + $letter_gap}] }
        set width 0
        foreach stroke [strokes_of $letter] { foreach {x y} $stroke { set width [expr {max($width, $x)}] } }
        expr {$width + $letter_gap}
    }

    # At size 1, in half heights of the window.
    proc text_width {text} {
        variable letter_unit
        set width 0
        foreach letter [split $text ""] { set width [expr {$width + [letter_advance $letter]}] }
        expr {$letter_unit * $width}
    }

    # Draws a text centred about x.
    proc draw_text {mol text x y size} {
        variable letter_unit
        variable drawn_texts
        dict lappend drawn_texts $mol $text
        set unit [expr {$letter_unit * $size}]
        set left [expr {$x - 0.5 * $size * [text_width $text]}]
        foreach letter [split $text ""] {
            foreach stroke [strokes_of $letter] { draw_stroke $mol $stroke $left $y $unit }
            set left [expr {$left + $unit * [letter_advance $letter]}]
        }
    }

    # Two triangles for each line, a little longer than it, so that corners are filled.
    proc draw_stroke {mol stroke left bottom unit} {
        variable stroke_width
        set half [expr {0.5 * $stroke_width * $unit}]
        foreach {x y} $stroke {
            set to [list [expr {$left + $unit * $x}] [expr {$bottom + $unit * $y}] 0]
            if {[info exists from]} {
                set along [vecscale $half [vecnorm [vecsub $to $from]]]
                lassign $along dx dy
                set aside [list [expr {-$dy}] $dx 0]
                set a [vecsub [vecsub $from $along] $aside]
                set b [vecsub [vecadd $to $along] $aside]
                set c [vecadd [vecadd $to $along] $aside]
                set d [vecadd [vecsub $from $along] $aside]
                graphics $mol triangle $a $b $c
                graphics $mol triangle $a $c $d
            }
            set from $to
        }
    }
}
