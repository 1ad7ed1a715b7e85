# heat_map.tcl: a matrix drawn on a canvas, with its pointer and arrow-key actions.

namespace eval ::espdiff::gui {
    variable heat {}  ;# layout: left, top, size of a cell, order of the variants
    variable colours         ;# by kind: sequential, diverging
    array set colours {}
    variable chosen_cell {}  ;# row and column, as drawn; empty for none

    # Draws each cell in its colour, labels on the left, and dots where a pair is not trustworthy.
    proc draw_heat_map {} {
        variable widget
        variable matrix_shown
        variable matrix_result
        variable heat
        set map $widget(matrix,map)
        $map delete all
        set heat {}
        if {$matrix_shown eq ""} return
        lassign [chosen_metric] name metric
        set order [matrix_order]
        set labels [matrix_labels]
        set n [llength $order]
        set height [expr {max(80, [winfo height $map] - 16 - [font metrics TkSmallCaptionFont -linespace])}]
        set left [label_width $labels]
        set room [expr {[winfo width $map] - $left - 96}]  ;# without labels and scale
        set cell [expr {max(3, min(44, $height / $n, $room / $n))}]
        incr left [expr {max(0, ($room - $n * $cell) / 2)}]
        set top 6
        set heat [dict create left $left top $top cell $cell order $order]
        lassign [value_range $metric] low high
        set trusted [dict get $matrix_result trustworthy]
        for {set row 0} {$row < $n} {incr row} {
            set i [lindex $order $row]
            set y [expr {$top + $row * $cell}]
            if {$cell >= 9} {
                $map create text [expr {$left - 5}] [expr {$y + $cell / 2}] -anchor e -text [lindex $labels $i] \
                    -font TkSmallCaptionFont
            }
            for {set column 0} {$column < $n} {incr column} {
                set j [lindex $order $column]
                set value [lindex [dict get $metric values] $i $j]
                set x [expr {$left + $column * $cell}]
                if {$value eq ""} {
                    $map create line $x $y [expr {$x + $cell}] [expr {$y + $cell}] -fill gray60
                    continue
                }
                $map create rectangle $x $y [expr {$x + $cell}] [expr {$y + $cell}] -outline "" \
                    -fill [heat_colour $name $value $low $high]
                if {![lindex $trusted $i $j] && $cell >= 8} { draw_dot $map $x $y $cell $name $value $low $high }
            }
        }
        $map create rectangle $left $top [expr {$left + $n * $cell}] [expr {$top + $n * $cell}] -outline black
        frame_groups $map $order
        $map create text [expr {$left + $n * $cell / 2}] [expr {$top + $n * $cell + 4}] -anchor n -font TkSmallCaptionFont \
            -text "Target, in the order of the rows (sources). Dot: not trustworthy; line: no value"
        draw_scale $map [expr {$left + $n * $cell + 18}] $top [expr {$n * $cell}] $name $metric $low $high
        mark_cell
    }

    proc label_width {labels} {
        set width 0
        foreach label $labels { set width [expr {max($width, [font measure TkSmallCaptionFont $label])}] }
        return [expr {min(180, $width) + 10}]
    }

    # Lowest and highest value; symmetric about 0 for signed metrics.
    proc value_range {metric} {
        set values [lsort -real [lsearch -all -inline -not -exact [concat {*}[dict get $metric values]] ""]]
        set low [lindex $values 0]
        set high [lindex $values end]
        if {[is_signed $metric]} {
            set high [expr {max(abs($low), abs($high))}]
            set low [expr {-$high}]
        }
        if {$high <= $low} { set high [expr {$low + max(1e-6, 1e-3 * abs($low))}] }
        return [list $low $high]
    }

    proc is_signed {metric} { string match "*signed difference" [dict get $metric title] }

    proc heat_colour {name value low high} {
        ramp_colour [expr {$name eq "mean_signed_difference" ? "diverging" : "sequential"}] \
            [expr {($value - $low) / double($high - $low)}]
    }

    proc ramp_colour {kind share} {
        variable colours
        if {![info exists colours($kind)]} { set colours($kind) [::espdiff::core::colours [expr {$kind eq "diverging" ? "red-blue" : $kind}] 101] }
        return [lindex $colours($kind) [expr {int(round(100 * max(0.0, min(1.0, $share))))}]]
    }

    # Dark on light, light on dark.
    proc draw_dot {map x y cell name value low high} {
        lassign [winfo rgb $map [heat_colour $name $value $low $high]] red green blue
        set fill [expr {0.3 * $red + 0.59 * $green + 0.11 * $blue > 32768 ? "gray20" : "gray90"}]
        set x [expr {$x + $cell / 2.0}]
        set y [expr {$y + $cell / 2.0}]
        set radius [expr {max(1.0, $cell / 14.0)}]
        $map create oval [expr {$x - $radius}] [expr {$y - $radius}] [expr {$x + $radius}] [expr {$y + $radius}] \
            -fill $fill -outline ""
    }

    # Frames consecutive variants of one group.
    proc frame_groups {map order} {
        variable matrix_result
        variable heat
        set first 0
        set n [llength $order]
        for {set place 1} {$place <= $n} {incr place} {
            set group [dict get [lindex [dict get $matrix_result variants] [lindex $order $first]] group]
            if {$place < $n && $group ne "" &&
                [dict get [lindex [dict get $matrix_result variants] [lindex $order $place]] group] eq $group} continue
            if {$group ne "" && $place - $first > 1} {
                dict with heat {
                    $map create rectangle [expr {$left + $first * $cell}] [expr {$top + $first * $cell}] \
                        [expr {$left + $place * $cell}] [expr {$top + $place * $cell}] -outline black -width 2
                }
            }
            set first $place
        }
    }

    proc draw_scale {map x top height name metric low high} {
        for {set i 0} {$i < 50} {incr i} {
            set y [expr {$top + $height * (1 - $i / 50.0)}]
            $map create rectangle $x [expr {$y - $height / 50.0}] [expr {$x + 14}] $y -outline "" \
                -fill [heat_colour $name [expr {$low + ($high - $low) * $i / 49.0}] $low $high]
        }
        $map create rectangle $x $top [expr {$x + 14}] [expr {$top + $height}] -outline black
        foreach share {0 0.5 1} {
            $map create text [expr {$x + 19}] [expr {$top + $height * (1 - $share) + (1 - 2 * $share) * -6}] -anchor w \
                -font TkSmallCaptionFont -text [with_unit [expr {$low + $share * ($high - $low)}]]
        }
        $map create text [expr {$x + 19}] [expr {$top + 0.25 * $height}] -anchor w -font TkSmallCaptionFont \
            -text [dict get $metric unit]
    }

    # Row and column under the pointer; empty on the diagonal and outside.
    proc cell_at {x y} {
        variable heat
        if {$heat eq ""} { return {} }
        dict with heat {
            set column [expr {int(floor(($x - $left) / double($cell)))}]
            set row [expr {int(floor(($y - $top) / double($cell)))}]
            set n [llength $order]
        }
        if {$row < 0 || $column < 0 || $row >= $n || $column >= $n || $row == $column} { return {} }
        return [list $row $column]
    }

    proc point_at {x y} {
        set cell [cell_at $x $y]
        if {$cell ne ""} { tell_cell $cell }
    }

    # Describes a cell.
    proc tell_cell {cell} {
        variable heat
        variable widget
        variable matrix_result
        lassign $cell row column
        set i [lindex [dict get $heat order] $row]
        set j [lindex [dict get $heat order] $column]
        set labels [matrix_labels]
        lassign [chosen_metric] name metric
        set trust [lindex [dict get $matrix_result trustworthy] $i $j]
        $widget(matrix,pair) configure -text "[lindex $labels $i] \u2192 [lindex $labels $j]:\
            [with_unit [lindex [dict get $metric values] $i $j] [dict get $metric unit]],\
            back [with_unit [lindex [dict get $metric values] $j $i] [dict get $metric unit]][expr {
                $trust eq "" ? "; could not be compared" : $trust ? "" : "; not trustworthy"}]"
    }

    proc open_pair_at {x y} {
        variable widget
        variable chosen_cell
        focus $widget(matrix,map)
        set cell [cell_at $x $y]
        if {$cell eq ""} return
        set chosen_cell $cell
        mark_cell
        open_chosen_pair
    }

    proc move_cell {rows columns} {
        variable chosen_cell
        variable heat
        if {$heat eq ""} return
        set n [llength [dict get $heat order]]
        lassign [expr {$chosen_cell eq "" ? {0 1} : $chosen_cell}] row column
        set row [expr {max(0, min($n - 1, $row + $rows))}]
        set column [expr {max(0, min($n - 1, $column + $columns))}]
        if {$row == $column} {
            # The diagonal is empty: skip to the other side, or back.
            if {$columns != 0} { incr column $columns } else { incr row $rows }
            if {$row < 0 || $column < 0 || $row >= $n || $column >= $n} return
        }
        set chosen_cell [list $row $column]
        mark_cell
        tell_cell $chosen_cell
    }

    proc mark_cell {} {
        variable widget
        variable chosen_cell
        variable heat
        $widget(matrix,map) delete chosen
        if {$chosen_cell eq "" || $heat eq ""} return
        lassign $chosen_cell row column
        if {max($row, $column) >= [llength [dict get $heat order]]} { set chosen_cell {}; return }
        dict with heat {
            $widget(matrix,map) create rectangle [expr {$left + $column * $cell}] [expr {$top + $row * $cell}] \
                [expr {$left + ($column + 1) * $cell}] [expr {$top + ($row + 1) * $cell}] -outline #e07000 -width 3 \
                -tags chosen
        }
    }

    # Compares the pair again, with its surface, and draws it.
    proc open_chosen_pair {} {
        variable chosen_cell
        variable heat
        variable matrix_pairs
        variable draw_when_done
        if {$chosen_cell eq ""} return
        lassign $chosen_cell row column
        lassign $matrix_pairs endpoints settings
        set source [lindex $endpoints [lindex [dict get $heat order] $row]]
        set target [lindex $endpoints [lindex [dict get $heat order] $column]]
        # The surface is drawn on the target: VMD shows the target's frame.
        if {[dict exists $target mol] && [dict get $target mol] in [molinfo list]} {
            molinfo [dict get $target mol] set frame [dict get $target frame]
        }
        set draw_when_done [start_compare $source $target $settings]
        set ::espdiff::gui::asking_tab matrix
        tell_in matrix "Comparing [lindex [matrix_labels] [lindex [dict get $heat order] $row]] with\
            [lindex [matrix_labels] [lindex [dict get $heat order] $column]]..."
    }

    proc plot_row {} {
        variable chosen_cell
        variable heat
        variable matrix_shown
        set row [expr {$chosen_cell eq "" ? 0 : [lindex $chosen_cell 0]}]
        lassign [chosen_metric] name
        espdiff plot $matrix_shown -source [lindex [matrix_labels] [lindex [dict get $heat order] $row]] -metrics $name
    }
}
