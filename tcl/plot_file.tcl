# plot_file.tcl: the plots of plot.tcl as pictures for publications, drawn by gnuplot as on the command line.

namespace eval ::espdiff {
    # `table` comes from plot_table. Points without a value leave a gap.
    proc plot_into_file {table options} {
        plot_series $table $options  ;# reports errors, as for VMD's windows
        set plot [dict create title [dict get $options title] normalize [dict get $options normalize]]
        if {[dict get $table names] eq ""} {
            dict set plot x [dict get $table x]
            dict set plot x_title [dict get $table x_title]
        } else {
            dict set plot labels [dict get $table names]
            dict set plot x_title Target
            if {[dict get $options title] eq ""} { dict set plot title [dict get $table title] }
        }
        foreach row [dict get $table rows] {
            dict lappend plot trustworthy [expr {[value_or $row trustworthy 1] ne "0"}]
        }
        foreach column [plot_metrics $table $options] { dict lappend plot series [plot_line $table $column] }
        core::check_outputs [value_or $table files {}] [list [file normalize [dict get $options file]]] [dict get $options overwrite]
        return [core::plot_lines [file normalize [dict get $options file]] $plot]
    }

    # A trajectory's table of residues.
    proc plot_residues {path options} {
        set file [dict get $options file]
        if {$file eq ""} {
            fail "espdiff plot: '$path' is a trajectory's table of residues, which is drawn into a file (-file OUT.png), or\
                in the window's tab Trajectory"
        }
        core::check_outputs [list $path] [list [file normalize $file]] [dict get $options overwrite]
        return [core::plot_residues [file normalize $file] $path]
    }

    # The core's series of a column, with printed units.
    proc plot_line {table column} {
        lassign [shown_metric $column [dict get $table unit]] title unit factor
        set values {}
        foreach row [dict get $table rows] {
            set value [dict get $row $column]
            lappend values [expr {[is_number $value] ? $factor * $value : ""}]
        }
        if {[string match {A*} $unit]} { set unit [string map [list A \u00c5 ^2 \u00b2] $unit] }
        return [dict create title $title unit $unit values $values]
    }
}
