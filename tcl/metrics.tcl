# metrics.tcl: the core's table of metrics, as commands, plots, the manual and the window read it.

namespace eval ::espdiff {
    # Names of the metrics that stand in one of residues, series and matrix, in the order of files.
    proc metric_names {place} {
        set names {}
        foreach metric [core::metrics] { if {[dict get $metric $place]} { lappend names [dict get $metric name] } }
        return $names
    }

    # The row of a metric; empty where there is none of that name.
    proc find_metric {name} {
        foreach metric [core::metrics] { if {[dict get $metric name] eq $name} { return $metric } }
        return {}
    }

    # The same of a column; "site_mean_abs_difference" is that of the patch site.
    proc metric_of_column {column} {
        set metric [find_metric $column]
        if {$metric ne ""} { return $metric }
        foreach metric [core::metrics] {
            set at [expr {[string length $column] - [string length [dict get $metric name]] - 1}]
            if {$at > 0 && [string range $column $at end] eq "_[dict get $metric name]"} {
                dict append metric title ", [string range $column 0 [expr {$at - 1}]]"
                return $metric
            }
        }
        return {}
    }

    # Title, unit, and the factor of values in it, of a column; the potentials are in `potential_unit`.
    proc shown_metric {column potential_unit} {
        if {$column eq "share"} { return {"Share of |difference| times area" "" 1} }
        if {$column eq "contribution"} { return [list "Contribution to the difference" $potential_unit 1] }
        set metric [metric_of_column $column]
        if {$metric eq ""} { return [list $column "" 1] }
        set unit [dict get $metric unit]
        if {$unit eq "potential"} { set unit $potential_unit }
        return [list [dict get $metric title] $unit [dict get $metric factor]]
    }

    # What a plot shows unless the user says.
    proc usual_metric {has_potentials} {
        expr {$has_potentials ? "mean_abs_difference" : "mean_displacement_A"}
    }

    # The manual's table.
    proc manual_of_metrics {} {
        set text "### Metrics\n\nThe numbers of a comparison, by their names in files, plots and `espdiff residues`;\
            *keys* are those of `espdiff result` and OUT.json.\nPotentials are in the result's unit. A metric is also\
            a column of a trajectory's CSV file, a table of a matrix, or a value of each\nresidue, where the last\
            column says so.\n"
        append text "\n| metric | unit | meaning | keys | also in |\n|---|---|---|---|---|\n"
        foreach metric [core::metrics] {
            set places {}
            foreach {place words} {series trajectory matrix matrix residues residues} {
                if {[dict get $metric $place]} { lappend places $words }
            }
            set keys [dict get $metric keys]
            set unit [expr {[dict get $metric kind] eq "fraction" ? "" : [dict get $metric unit]}]
            append text "| `[dict get $metric name]` | $unit | [dict get $metric help] |\
                [expr {$keys eq "" ? "" : "`$keys`"}] | [join $places {, }] |\n"
        }
        return $text
    }
}
