# plot.tcl: lines along a trajectory, or of one variant against all, in VMD's own plot windows (the package multiplot).

namespace eval ::espdiff {
    # The action of a click, by number of the window: {callback molecule x names}. multiplot writes its callback into a
    # Tk binding, where only a short word is safe.
    variable plot_clicks [dict create]

    variable plot_colours {#0072b2 #d55e00 #009e73 #cc79a7 #56b4e9 #e69f00 #000000}

    # A window for each unit, or one for normalized values.
    proc plot {options input} {
        if {![exists $input] && ![is_trajectory $input]} {
            set path [existing_file $input "espdiff plot"]
            if {[core::is_residue_table $path]} { return [plot_residues $path $options] }
        }
        set table [plot_table $input $options]
        if {[dict get $options file] ne ""} { return [plot_into_file $table $options] }
        set series [plot_series $table $options]
        require_multiplot
        set panels [dict create]
        foreach line $series {
            set unit [expr {[dict get $options normalize] ? "normalized" : [dict get $line unit]}]
            dict lappend panels $unit $line
        }
        set plots {}
        dict for {unit lines} $panels { lappend plots [plot_window $unit $lines $table $options] }
        return $plots
    }

    proc require_multiplot {} {
        if {![info exists ::tk_version]} {
            fail "espdiff plot needs VMD with its graphics window; elsewhere -file OUT.svg draws the same into a\
                file"
        }
        if {[catch { package require multiplot } message]} {
            fail "espdiff plot needs VMD's package multiplot, which is not there ($message); -file OUT.svg draws\
                the same into a file"
        }
    }

    # A dict: x, names (of the points; empty if x is numeric), x_title, title, rows (dicts by column), unit, columns.
    proc plot_table {input options} {
        if {[exists $input] || [is_trajectory $input]} {
            if {[is_trajectory $input]} { return [plot_csv [dict get [trajectory_result $input] csv]] }
            return [plot_matrix $input [dict get $options source]]
        }
        return [plot_csv [existing_file $input "espdiff plot"]]
    }

    proc plot_csv {path} {
        set table [core::read_csv $path]
        set columns [dict get $table columns]
        set rows [dict get $table rows]
        if {"frame" ni $columns} {
            fail "espdiff plot: '$path' has no column `frame`; it is not of a trajectory" FORMAT
        }
        set x {}
        set unit ""
        foreach row $rows {
            lappend x [dict get $row frame]
            if {[value_or $row potential_unit ""] ne ""} { set unit [dict get $row potential_unit] }
        }
        return [dict create x $x names {} x_title Frame title [file tail $path] rows $rows unit $unit columns $columns \
            files [list $path]]
    }

    # One variant as the source against all others.
    proc plot_matrix {handle source} {
        set matrix [core::result $handle]
        if {![dict exists $matrix variants]} { fail "$handle is no matrix; give one, or a trajectory's CSV file" }
        set labels {}
        foreach variant [dict get $matrix variants] { lappend labels [dict get $variant label] }
        if {$source eq ""} { set source [lindex $labels 0] }
        set from [lsearch -exact $labels $source]
        if {$from < 0} { fail "-source: [unknown_word variant $source $labels]" }
        set rows {}
        set x {}
        set names {}
        for {set to 0} {$to < [llength $labels]} {incr to} {
            if {$to == $from} continue
            set row [dict create]
            dict for {name metric} [dict get $matrix metrics] {
                dict set row $name [lindex [dict get $metric values] $from $to]
            }
            dict set row trustworthy [lindex [dict get $matrix trustworthy] $from $to]
            lappend rows $row
            lappend x $to
            lappend names [lindex $labels $to]
        }
        return [dict create x $x names $names x_title "Variant, by its number in the list from 0" \
            title "$source against all others" rows $rows unit [dict get $matrix potential_unit] \
            columns [dict keys [dict get $matrix metrics]]]
    }

    proc plot_metrics {table options} {
        set metrics [dict get $options metrics]
        if {$metrics ne "auto"} { return $metrics }
        usual_metric [expr {[dict get $table unit] ne ""}]
    }

    # A dict for each metric: title, unit, x, y; points without a value are omitted.
    proc plot_series {table options} {
        set all {}
        foreach column [plot_metrics $table $options] {
            if {$column ni [dict get $table columns]} {
                fail "-metrics: [unknown_word metric $column [dict get $table columns]]"
            }
            lassign [shown_metric $column [dict get $table unit]] title unit factor
            set x {}
            set y {}
            foreach at [dict get $table x] row [dict get $table rows] {
                set value [dict get $row $column]
                if {![is_number $value]} continue
                lappend x $at
                lappend y [expr {$factor * $value}]
            }
            if {[llength $y] == 0} { fail "-metrics: '$column' has no values" }
            lappend all [plot_normalized [dict create title $title unit $unit x $x y $y] [dict get $options normalize]]
        }
        if {[llength $all] == 0} { fail "-metrics: none was named" }
        return $all
    }

    proc plot_normalized {line wanted} {
        if {!$wanted} { return $line }
        set sorted [lsort -real [dict get $line y]]
        set low [lindex $sorted 0]
        set span [expr {[lindex $sorted end] - $low}]
        set y {}
        foreach value [dict get $line y] { lappend y [expr {$span > 0 ? ($value - $low) / double($span) : 0.5}] }
        set unit [dict get $line unit]
        dict set line title [format "%s (0: %.3g%s, 1: %.3g%s)" [dict get $line title] $low \
            [expr {$unit eq "" ? "" : " $unit"}] [lindex $sorted end] [expr {$unit eq "" ? "" : " $unit"}]]
        dict set line y $y
        return $line
    }

    proc plot_window {unit lines table options} {
        variable plot_colours
        variable plot_clicks
        set number [dict size $plot_clicks]
        dict set plot_clicks $number [list [dict get $options callback] [dict get $options mol] [dict get $table x] \
            [dict get $table names]]
        set title [dict get $table title]
        if {[dict get $options title] ne ""} { set title [dict get $options title] }
        set label [expr {$unit eq "normalized" ? "normalized"
            : [llength $lines] == 1 ? [dict get [lindex $lines 0] title] : "value"}]
        if {$unit ni {normalized ""}} { append label " ($unit)" }
        set plot [multiplot -title $title -xlabel [dict get $table x_title] -ylabel $label -xsize 700 -ysize 420]
        set i 0
        foreach line $lines {
            set colour [lindex $plot_colours [expr {$i % [llength $plot_colours]}]]
            $plot add [dict get $line x] [dict get $line y] -lines -linewidth 2 -linecolor $colour -marker point \
                -radius 4 -fillcolor $colour -legend [dict get $line title] \
                -callback [list ::espdiff::plot_clicked $number]
            incr i
        }
        if {[dict get $table names] ne ""} {
            set step [expr {1 + [llength [dict get $table names]] / 20}]
            $plot configure -xmajortics $step -xminortics $step
        }
        $plot replot
        return $plot
    }

    # Called by multiplot with the clicked point.
    proc plot_clicked {number index x y colour marker} {
        variable plot_clicks
        lassign [dict get $plot_clicks $number] callback mol positions names
        set name [lindex $names [lsearch -exact -real $positions $x]]
        if {$callback ne ""} {
            if {$names eq ""} { set name $x }  ;# not by `expr`, which makes 8 of a label 010
            call_user $callback $name $y
        } elseif {$names eq "" && $mol ne "none" && [in_vmd]} {
            molinfo [vmd_molecule_id $mol -mol] set frame [expr {int($x)}]
        }
    }
}
