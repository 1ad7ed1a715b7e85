# ensemble_series.tcl: the mean of a patch in every frame, replicate beside replicate; the frame under the pointer.

namespace eval ::espdiff::gui {
    variable series_frame {}  ;# layout: left, top, width, height in pixels; n frames; low, high; values, rows
    variable series_inks {#0072b2 #d55e00}  ;# by group

    proc draw_series {} {
        variable widget
        variable series_frame {}
        variable ensemble_patches
        variable ensemble_patch
        if {![info exists widget(ensemble,plot)] || ![winfo exists $widget(ensemble,plot)]} return
        set plot $widget(ensemble,plot)
        $plot delete all
        if {$ensemble_patch eq ""} {
            $plot create text [expr {[winfo width $plot] / 2}] [expr {[winfo height $plot] / 2}] -fill gray40 \
                -text [expr {[llength $ensemble_patches] == 0 ? "" : "A click on a patch shows its mean in every frame."}]
            return
        }
        set rows [dict get [lindex $ensemble_patches [expr {$ensemble_patch - 1}]] series]
        set values {}
        foreach row $rows { lappend values [lindex $row 3] }
        set present [lsearch -all -inline -not -exact $values ""]
        if {[llength $present] == 0} return
        set sorted [lsort -real $present]
        lassign [round_ends [lindex $sorted 0] [lindex $sorted end]] low high step
        set left [expr {14 + max([tick_width $low $step], [tick_width $high $step])}]
        set series_frame [dict create left $left top 24 width [expr {max(40, [winfo width $plot] - $left - 12)}] \
            height [expr {max(30, [winfo height $plot] - 24 - 22)}] n [llength $rows] low $low high $high step $step \
            rows $rows]
        draw_series_axes $plot
        draw_series_runs $plot $rows
    }

    proc series_x {number} {
        variable series_frame
        dict with series_frame { expr {$left + $width * ($number + 0.5) / double($n)} }
    }

    proc series_y {value} {
        variable series_frame
        dict with series_frame { expr {$top + $height * (1 - ($value - $low) / double($high - $low))} }
    }

    proc draw_series_axes {plot} {
        variable series_frame
        variable plot_inks
        variable ensemble_shown
        variable ensemble_patch
        dict with series_frame {
            for {set i 0} {$low + $i * $step <= $high + 1e-9 * $step} {incr i} {
                set value [expr {$low + $i * $step}]
                set y [series_y $value]
                $plot create line $left $y [expr {$left + $width}] $y -fill [dict get $plot_inks grid]
                $plot create text [expr {$left - 6}] $y -anchor e -font TkSmallCaptionFont -text [tick_text $value $step]
            }
            $plot create rectangle $left $top [expr {$left + $width}] [expr {$top + $height}] \
                -outline [dict get $plot_inks axis]
            $plot create text $left [expr {$top - 6}] -anchor sw -font TkSmallCaptionFont \
                -text "Mean of patch $ensemble_patch ([espdiff result $ensemble_shown potential_unit])"
        }
    }

    # Each replicate's line with its name below, and each group's mean.
    proc draw_series_runs {plot rows} {
        variable series_frame
        variable series_inks
        variable plot_inks
        set runs [dict create]
        set number 0
        foreach row $rows { dict lappend runs [lrange $row 0 1] [list $number [lindex $row 3]]; incr number }
        set groups {}
        set bottom [expr {[dict get $series_frame top] + [dict get $series_frame height]}]
        set right [expr {[dict get $series_frame left] + [dict get $series_frame width]}]
        dict for {name points} $runs {
            lassign $name group replicate
            if {$group ni $groups} { lappend groups $group }
            set ink [lindex $series_inks [lsearch -exact $groups $group]]
            set line {}
            foreach point $points {
                lassign $point at value
                if {$value ne ""} { lappend line [series_x $at] [series_y $value]; lappend means($group) $value }
            }
            if {[llength $line] > 2} { $plot create line $line -fill $ink -width 1.5 -tags run }
            set first [series_x [expr {[lindex $points 0 0] - 0.5}]]
            set last [series_x [expr {[lindex $points end 0] + 0.5}]]
            lappend ends($group) $first $last
            $plot create line $first [dict get $series_frame top] $first $bottom -fill [dict get $plot_inks grid]
            $plot create text [expr {($first + $last) / 2}] [expr {$bottom + 4}] -anchor n -font TkSmallCaptionFont \
                -text $replicate -fill $ink -width [expr {$last - $first}]
        }
        foreach group $groups {
            if {![info exists means($group)]} continue
            set y [series_y [expr {[::tcl::mathop::+ 0.0 {*}$means($group)] / [llength $means($group)]}]]
            set ink [lindex $series_inks [lsearch -exact $groups $group]]
            $plot create line [lindex $ends($group) 0] $y [lindex $ends($group) end] $y -fill $ink -dash {6 3} -width 2 \
                -tags mean
            $plot create text $right [expr {[dict get $series_frame top] - 6}] -anchor se -font TkSmallCaptionFont \
                -text $group -fill $ink -tags key
            set right [expr {[lindex [$plot bbox key] 0] - 10}]
        }
    }

    # The row of the frame at this place; empty outside the plot.
    proc series_row_at {x} {
        variable series_frame
        if {$series_frame eq ""} return
        dict with series_frame {
            set number [expr {int(floor(($x - $left) * $n / double($width)))}]
            if {$number < 0 || $number >= $n} return
            return [lindex $rows $number]
        }
    }

    proc tell_series_at {x} {
        variable widget
        variable ensemble_shown
        set row [series_row_at $x]
        if {$row eq ""} { $widget(ensemble,point) configure -text ""; return }
        lassign $row group replicate frame value
        $widget(ensemble,point) configure -text "$group, $replicate, frame $frame: [with_unit $value \
            [espdiff result $ensemble_shown potential_unit]][expr {[frame_in_vmd $row] eq "" ? "" :
                "; a click shows it in VMD"}]"
    }

    # Molecule and frame of a row in VMD; empty for a file's, and where the molecule is gone.
    proc frame_in_vmd {row} {
        variable ensemble_run
        lassign $row group replicate frame
        if {![in_vmd] || $ensemble_run eq ""} return
        foreach known [dict get $ensemble_run replicates] {
            if {[list [dict get $known group] [dict get $known label]] ne [list $group $replicate]} continue
            set endpoint [dict get $known endpoint]
            if {![dict exists $endpoint mol] || [dict get $endpoint mol] ni [molinfo list]} return
            set mol [dict get $endpoint mol]
            set number [lindex [::espdiff::vmd_frames $mol [dict get $endpoint frames] Frames] $frame]
            if {$number eq ""} return
            return [list $mol $number]
        }
    }

    proc show_frame_at {x} {
        variable widget
        set row [series_row_at $x]
        if {$row eq ""} return
        lassign [frame_in_vmd $row] mol frame
        if {$mol eq ""} return
        show_molecule_alone $mol $frame
        $widget(ensemble,plot) delete now
        $widget(ensemble,plot) create line $x [dict get $::espdiff::gui::series_frame top] $x \
            [expr {[dict get $::espdiff::gui::series_frame top] + [dict get $::espdiff::gui::series_frame height]}] \
            -dash {4 3} -fill gray60 -tags now
    }

    # One of the run's molecules at a frame, the others of it hidden.
    proc show_molecule_alone {mol frame} {
        variable ensemble_run
        foreach replicate [dict get $ensemble_run replicates] {
            set other [::espdiff::value_or [dict get $replicate endpoint] mol ""]
            if {$other ne "" && $other != $mol && $other in [molinfo list]} { mol off $other }
        }
        mol on $mol
        molinfo $mol set frame $frame
    }
}
