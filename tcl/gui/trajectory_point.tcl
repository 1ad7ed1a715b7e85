# trajectory_point.tcl: a point of the trajectory's plot: choice by pointer or keys, its frame in VMD, its comparison.

namespace eval ::espdiff::gui {
    variable chosen_point ""  ;# number of a row; empty for none

    # The VMD molecule of the rows' frames; empty for files, or if it is deleted.
    proc trajectory_molecule {} {
        variable trajectory_run
        if {![in_vmd] || $trajectory_run eq "" || ![dict exists $trajectory_run options -mol]} { return "" }
        set mol [dict get $trajectory_run options -mol]
        expr {$mol in [molinfo list] ? $mol : ""}
    }

    # The row whose point is nearest in x; empty outside the plot.
    proc point_near {x y} {
        variable plot_frame
        if {$plot_frame eq ""} { return "" }
        dict with plot_frame {
            if {$x < $left - 6 || $x > $left + $width + 6 || $y < $top - 6 || $y > $top + $height + 6} { return "" }
        }
        set best ""
        set least 1e9
        foreach point [dict get $plot_frame points] {
            lassign $point row at
            if {abs($at - $x) < $least} { set best $row; set least [expr {abs($at - $x)}] }
        }
        return $best
    }

    proc tell_point_at {x y} {
        if {[shows_residue_map]} {
            set cell [residue_cell_at $x $y]
            if {$cell eq ""} { tell_chosen_point } else { tell_residue_cell {*}$cell }
            return
        }
        set row [point_near $x $y]
        if {$row eq ""} { tell_chosen_point } else { tell_row $row }
    }

    proc tell_chosen_point {} {
        variable widget
        variable chosen_point
        variable trajectory_rows
        variable chosen_residue
        if {[shows_residue_map] && $chosen_residue ne ""} {
            tell_residue_cell $chosen_residue [chosen_column]
        } elseif {$chosen_point ne ""} {
            tell_row $chosen_point
        } else {
            $widget(trajectory,point) configure -text [expr {[llength $trajectory_rows] == 0 ? "" : [in_vmd]
                ? "A click on a point, or the arrow keys, show its frame in VMD." : "A click chooses a frame."}]
        }
    }

    # Describes a frame.
    proc tell_row {row} {
        variable widget
        variable trajectory_rows
        set cells [lindex $trajectory_rows $row]
        lassign [chosen_trajectory_metric] column title unit factor
        set value [dict get $cells $column]
        if {[dict get $cells error] ne ""} {
            set text [dict get $cells error]
        } elseif {[::espdiff::is_number $value]} {
            set text [with_unit [expr {$factor * $value}] [string map [list A \u00c5 ^2 \u00b2] $unit]]
            if {![row_is_good $cells]} { append text "; not trustworthy: [dict get $cells reasons]" }
        } else {
            set text "no value"
        }
        set text "Frame [dict get $cells frame] against [dict get $cells reference_frame]: $text"
        $widget(trajectory,point) configure -text $text
    }

    proc choose_point_at {x y} {
        variable widget
        focus $widget(trajectory,plot)
        if {[shows_residue_map]} {
            set cell [residue_cell_at $x $y]
            if {$cell ne ""} { choose_residue_cell {*}$cell }
            return
        }
        set row [point_near $x $y]
        if {$row ne ""} { choose_point $row }
    }

    proc move_point {step} {
        variable chosen_point
        variable trajectory_rows
        set n [llength $trajectory_rows]
        if {$n == 0} return
        set now [expr {$chosen_point eq "" ? ($step > 0 ? -1 : $n) : $chosen_point}]
        choose_point [expr {max(0, min($n - 1, $now + $step))}]
    }

    # Takes VMD to the point's frame, of both trajectories where each frame has its source in another one.
    proc choose_point {row} {
        variable chosen_point
        variable trajectory_rows
        set chosen_point $row
        set frame [dict get [lindex $trajectory_rows $row] frame]
        foreach mol [lsort -unique [list [trajectory_molecule] [named_molecule]]] {
            if {$mol ne "" && $frame < [molinfo $mol get numframes]} { molinfo $mol set frame $frame }
        }
        mark_now
        if {[shows_residue_map]} { mark_residue; tell_chosen_point } else { mark_point; tell_row $row }
        show_trajectory_running
    }

    proc mark_point {} {
        variable widget
        variable plot_frame
        variable plot_inks
        variable chosen_point
        $widget(trajectory,plot) delete chosen
        if {$chosen_point eq "" || $plot_frame eq ""} return
        lassign [lindex [dict get $plot_frame points] $chosen_point] row x y
        if {$x eq ""} return
        if {$y eq ""} { set y [expr {[dict get $plot_frame top] + [dict get $plot_frame height] - 6}] }
        $widget(trajectory,plot) create oval [expr {$x - 8}] [expr {$y - 8}] [expr {$x + 8}] [expr {$y + 8}] \
            -outline [dict get $plot_inks chosen] -width 3 -tags chosen
    }

    # The pair of a row as endpoints of `espdiff compare`, source first.
    proc endpoints_of_row {row} {
        variable trajectory_run
        variable trajectory_rows
        set options [dict get $trajectory_run options]
        set cells [lindex $trajectory_rows $row]
        set pair {}
        set reference [dict get $options -reference]
        set has_other [expr {[llength $reference] == 4}]
        foreach frame [list [dict get $cells reference_frame] [dict get $cells frame]] {
            if {$has_other && [llength $pair] == 0} {
                lassign $reference kind other
                set endpoint [expr {$kind eq "mol" ? [list mol $other frame $frame]
                    : [list file $other model [expr {$frame + 1}]]}]
                if {$kind eq "mol" && [dict exists $options -sel]} { lappend endpoint sel [dict get $options -sel] }
            } elseif {[dict exists $options -mol]} {
                set endpoint [list mol [dict get $options -mol] frame $frame]
                if {[dict exists $options -sel]} { lappend endpoint sel [dict get $options -sel] }
            } else {
                set endpoint [list file [dict get $options -file] model [expr {$frame + 1}]]
            }
            if {[dict exists $options -map]} { lappend endpoint map [map_of_frame [dict get $options -map] $frame] }
            if {[dict exists $options -unit]} { lappend endpoint unit [dict get $options -unit] }
            lappend pair $endpoint
        }
        return $pair
    }

    proc map_of_frame {map frame} {
        if {[lindex $map 0] ne "files"} { return $map }
        return [list file [format [lindex $map 1] $frame]]
    }

    # Compares the chosen frame again, and draws it.
    proc compare_frame {} {
        variable chosen_point
        variable trajectory_run
        variable draw_when_done
        if {$chosen_point eq ""} return
        lassign [endpoints_of_row $chosen_point] source target
        choose_point $chosen_point  ;# the surface is drawn on the target: VMD shows its frame
        set draw_when_done [start_compare $source $target [dict get $trajectory_run settings]]
        set ::espdiff::gui::asking_tab trajectory
        tell_in trajectory "Comparing frame [dict get [lindex $::espdiff::gui::trajectory_rows $chosen_point] frame]..."
    }
}
