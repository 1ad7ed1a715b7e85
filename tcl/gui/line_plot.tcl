# line_plot.tcl: plots a metric against the frames on a canvas, while the run proceeds.

namespace eval ::espdiff::gui {
    variable plot_frame {}  ;# layout: left, top, width, height in pixels; x_low, x_high, y_low, y_high; points
    variable plot_inks {line #0072b2 pale #9cc4e4 mean #d55e00 chosen #e07000 axis gray30 grid gray90 now gray60 failed #b00020}

    # points: {row x y} for each row, in pixels; y is empty if the row has no number.
    proc draw_trajectory {} {
        variable widget
        variable plot_frame
        variable trajectory_rows
        variable residue_layout
        if {![info exists widget(trajectory,plot)] || ![winfo exists $widget(trajectory,plot)]} return
        set plot $widget(trajectory,plot)
        $plot delete all
        set plot_frame {}
        set residue_layout {}
        show_trajectory_running
        set metric [chosen_trajectory_metric]
        if {$metric eq ""} {
            $plot create text [expr {[winfo width $plot] / 2}] [expr {[winfo height $plot] / 2}] -fill gray40 \
                -text "Each frame becomes a point here as soon as it is compared."
            return
        }
        if {[shows_residue_map]} {
            update_residue_table
            draw_residue_map $plot
            mark_now
            tell_chosen_point
            return
        }
        lassign $metric column title unit factor
        set frames {}
        set values {}
        foreach row $trajectory_rows {
            set value [dict get $row $column]
            lappend frames [dict get $row frame]
            lappend values [expr {[::espdiff::is_number $value] ? $factor * $value : ""}]
        }
        set plot_frame [plot_frame_of $plot $frames $values]
        draw_axes $plot $title [string map [list A \u00c5 ^2 \u00b2] $unit]
        dict set plot_frame points [points_of $frames $values]
        draw_points $plot
        draw_running_mean $plot $frames $values
        mark_now
        mark_point
        tell_chosen_point
    }

    # Axes with room for any value, and round ends.
    proc plot_frame_of {plot frames values} {
        variable trajectory_rows
        set sorted [lsort -real [lsearch -all -inline -not -exact $values ""]]
        lassign [round_ends [lindex $sorted 0] [lindex $sorted end]] y_low y_high y_step
        set frames [lsort -real $frames]
        lassign [list [lindex $frames 0] [lindex $frames end]] x_low x_high
        if {$x_high <= $x_low} { set x_high [expr {$x_low + 1}] }
        set left [expr {14 + max([tick_width $y_low $y_step], [tick_width $y_high $y_step])}]
        return [dict create left $left top 26 width [expr {max(40, [winfo width $plot] - $left - 20)}] \
            height [expr {max(40, [winfo height $plot] - 26 - 40)}] x_low $x_low x_high $x_high \
            y_low $y_low y_high $y_high y_step $y_step points {}]
    }

    proc tick_width {value step} { font measure TkSmallCaptionFont [tick_text $value $step] }

    # As many decimals as the step.
    proc tick_text {value step} {
        if {abs($value) < 1e-9 * $step} { set value 0 }
        format %.*f [expr {max(0, -int(floor(log10($step) + 1e-9)))}] $value
    }

    # The round step (1, 2 or 5 times a power of ten) that gives about `n` steps in the span.
    proc round_step {span n} {
        set power [expr {pow(10, floor(log10($span / double($n))))}]
        foreach factor {1 2 5} { if {$span / ($factor * $power) <= $n} { return [expr {$factor * $power}] } }
        return [expr {10 * $power}]
    }

    # Round ends of an axis that contains both values, and the step between ticks. A nearby 0 becomes an end.
    proc round_ends {low high} {
        if {$low > 0 && $low < 0.5 * $high} { set low 0 }
        if {$high < 0 && $high > 0.5 * $low} { set high 0 }
        if {$high - $low < 1e-9 * max(abs($high), abs($low), 1e-6)} {
            set half [expr {max(1e-6, 0.1 * abs($high))}]
            set low [expr {$low - $half}]
            set high [expr {$high + $half}]
        }
        set step [round_step [expr {$high - $low}] 5]
        list [expr {$step * floor($low / $step + 1e-9)}] [expr {$step * ceil($high / $step - 1e-9)}] $step
    }

    proc draw_axes {plot title unit} {
        variable plot_frame
        variable plot_inks
        dict with plot_frame {
            set bottom [expr {$top + $height}]
            set right [expr {$left + $width}]
            for {set i 0} {$y_low + $i * $y_step <= $y_high + 1e-9 * $y_step} {incr i} {
                set value [expr {$y_low + $i * $y_step}]
                set y [plot_y $value]
                $plot create line $left $y $right $y -fill [dict get $plot_inks grid]
                $plot create text [expr {$left - 6}] $y -anchor e -font TkSmallCaptionFont \
                    -text [tick_text $value $y_step]
            }
            set step [expr {max(1, int([round_step [expr {$x_high - $x_low}] 8]))}]
            set value [expr {int(ceil($x_low / double($step))) * $step}]
            for {} {$value <= $x_high} {incr value $step} {
                set x [plot_x $value]
                $plot create line $x $bottom $x [expr {$bottom + 4}] -fill [dict get $plot_inks axis]
                $plot create text $x [expr {$bottom + 6}] -anchor n -font TkSmallCaptionFont -text $value
            }
            $plot create rectangle $left $top $right $bottom -outline [dict get $plot_inks axis]
            $plot create text $left [expr {$top - 7}] -anchor sw -font TkSmallCaptionFont \
                -text "$title[expr {$unit eq "" ? "" : " ($unit)"}]"
            $plot create text [expr {($left + $right) / 2}] [expr {$bottom + 22}] -anchor n -font TkSmallCaptionFont \
                -text Frame
            draw_key $plot $right [expr {$top - 7}]
        }
    }

    # Explains hollow points and crosses, if there are any.
    proc draw_key {plot right baseline} {
        variable trajectory_rows
        set words {}
        foreach row $trajectory_rows {
            if {[dict get $row error] ne ""} {
                dict set words "cross: could not be compared" 1
            } elseif {![row_is_good $row]} {
                dict set words "hollow: not trustworthy" 1
            }
        }
        if {$words eq ""} return
        $plot create text $right $baseline -anchor se -font TkSmallCaptionFont -fill gray40 \
            -text [join [lsort -decreasing [dict keys $words]] ", "]
    }

    proc plot_x {value} {
        variable plot_frame
        dict with plot_frame {
            expr {$left + 8 + ($width - 16) * ($value - $x_low) / double($x_high - $x_low)}
        }
    }

    proc plot_y {value} {
        variable plot_frame
        dict with plot_frame { expr {$top + $height * (1 - ($value - $y_low) / double($y_high - $y_low))} }
    }

    proc points_of {frames values} {
        set points {}
        set row -1
        foreach frame $frames value $values {
            lappend points [list [incr row] [plot_x $frame] [expr {$value eq "" ? "" : [plot_y $value]}]]
        }
        return $points
    }

    # A line through consecutive frames with values; filled points, hollow if not trustworthy; crosses on the axis for
    # frames without values.
    proc draw_points {plot} {
        variable plot_frame
        variable plot_inks
        variable trajectory_rows
        set bottom [expr {[dict get $plot_frame top] + [dict get $plot_frame height]}]
        set line {}
        foreach point [concat [dict get $plot_frame points] {{"" "" ""}}] {
            lassign $point row x y
            if {$y ne ""} { lappend line $x $y; continue }
            if {[llength $line] > 2} { $plot create line $line -fill [dict get $plot_inks line] -width 2 }
            set line {}
            if {$row eq ""} continue
            foreach slope {1 -1} {
                $plot create line [expr {$x - 4}] [expr {$bottom - 6 - 4 * $slope}] [expr {$x + 4}] \
                    [expr {$bottom - 6 + 4 * $slope}] -fill [dict get $plot_inks failed] -width 2 -tags failed
            }
        }
        foreach point [dict get $plot_frame points] {
            lassign $point row x y
            if {$y eq ""} continue
            set good [row_is_good [lindex $trajectory_rows $row]]
            $plot create oval [expr {$x - 4}] [expr {$y - 4}] [expr {$x + 4}] [expr {$y + 4}] \
                -outline [dict get $plot_inks line] -width 2 -tags [expr {$good ? "good" : "bad"}] \
                -fill [expr {$good ? [dict get $plot_inks line] : "white"}]
        }
    }

    # The running mean over as many rows as the user wants, over paler points; none for 1.
    proc draw_running_mean {plot frames values} {
        variable form
        variable plot_inks
        set n [string trim $form(trajectory,smooth)]
        if {![string is integer -strict $n] || $n < 1} { error "Mean over: '$n' is not a whole number from 1 on" }
        if {$n == 1} return
        set line {}
        foreach frame $frames mean [running_mean $values $n] {
            if {$mean ne ""} { lappend line [plot_x $frame] [plot_y $mean] }
        }
        foreach tag {good bad} { $plot itemconfigure $tag -outline [dict get $plot_inks pale] }
        $plot itemconfigure good -fill [dict get $plot_inks pale]
        if {[llength $line] > 2} {
            $plot create line $line -fill [dict get $plot_inks mean] -width 3 -tags mean
        }
    }

    # Means over n values around each, fewer at the ends; missing ones ("") are left out.
    proc running_mean {values n} {
        set before [expr {($n - 1) / 2}]
        set means {}
        for {set i 0} {$i < [llength $values]} {incr i} {
            set some [lsearch -all -inline -not -exact [lrange $values [expr {max(0, $i - $before)}] \
                [expr {$i - $before + $n - 1}]] ""]
            lappend means [expr {[llength $some] == 0 ? "" : [::tcl::mathop::+ 0.0 {*}$some] / [llength $some]}]
        }
        return $means
    }

    # A dashed line at the frame that VMD shows.
    proc mark_now {args} {
        variable widget
        variable plot_frame
        variable plot_inks
        if {![info exists widget(trajectory,plot)] || ![winfo exists $widget(trajectory,plot)]} return
        $widget(trajectory,plot) delete now
        set mol [trajectory_molecule]
        if {$mol eq ""} return
        set frame [molinfo $mol get frame]
        if {[shows_residue_map]} { mark_frame_of_map $frame; return }
        if {$plot_frame eq ""} return
        dict with plot_frame {
            if {$frame < $x_low || $frame > $x_high} return
            set x [plot_x $frame]
            $widget(trajectory,plot) create line $x $top $x [expr {$top + $height}] -dash {4 3} \
                -fill [dict get $plot_inks now] -tags now
        }
        $widget(trajectory,plot) lower now
    }
}
