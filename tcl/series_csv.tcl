# series_csv.tcl: the CSV file of a trajectory: one row a frame, written as it is done, and read back to go on.

namespace eval ::espdiff {
    variable csv_columns {
        frame reference_frame rmsd_A potential_unit mean_abs_difference rms_difference mean_signed_difference
        sign_change_area_fraction hodgkin_index mean_displacement_A area_mapped_A2 corrupt_area_fraction
        flipped_area_fraction no_counterpart_source no_counterpart_target target_to_mapped_max_A converged trustworthy
        start iterations time_ms reasons error
    }

    # Where the columns come from in core::result, where the key is not the column's name.
    variable csv_sources {
        area_mapped_A2 {area_A2 mapped}
        corrupt_area_fraction {certificate corrupt_area_fraction}
        flipped_area_fraction {certificate flipped_area_fraction}
        no_counterpart_source {certificate no_counterpart_area_fraction source}
        no_counterpart_target {certificate no_counterpart_area_fraction target}
        target_to_mapped_max_A {certificate target_to_mapped_A max}
        converged {certificate converged}
        trustworthy {certificate trustworthy}
        time_ms {time_ms total}
        reasons {certificate reasons}
    }

    # A row as a dict by column; `error` is why there are no numbers.
    proc csv_row {frame reference result {error {}}} {
        variable csv_columns
        variable csv_sources
        set row [dict create]
        foreach column $csv_columns {
            set keys [value_or $csv_sources $column $column]
            set value ""
            if {$error eq "" && [dict exists $result {*}$keys]} { set value [dict get $result {*}$keys] }
            dict set row $column $value
        }
        dict set row frame $frame
        dict set row reference_frame $reference
        dict set row reasons [join [dict get $row reasons] "; "]
        dict set row error $error
        return $row
    }

    proc csv_line {values} {
        set cells {}
        foreach value $values {
            set value [one_line $value]  ;# a row is a line: what is not complete can be told by its end
            if {[regexp {[,"]} $value]} { set value "\"[string map {\" \"\"} $value]\"" }
            lappend cells $value
        }
        return [join $cells ,]
    }

    proc csv_cells {line} {
        set cells {}
        set rest $line,
        while {$rest ne ""} {
            if {![regexp {^(?:"((?:[^"]|"")*)"|([^",]*)),(.*)$} $rest all quoted bare rest]} { return {} }
            lappend cells [string map {\"\" \"} $quoted]$bare
        }
        return $cells
    }

    # The file for a run: the rows that it has already, as dicts, and what it says of itself. `about` is what a file
    # must have been made with to be gone on with: a dict of texts.
    proc csv_open {path resume overwrite about} {
        if {$resume && $overwrite} { fail "-resume and -overwrite exclude each other" }
        if {![file exists $path] || [file size $path] == 0 || $overwrite} {
            csv_write $path w {}
            return {}
        }
        if {!$resume} { fail "-csv: the file '$path' exists; -resume 1 goes on with it, -overwrite 1 replaces it" IO }
        return [csv_read $path $about]
    }

    # Each call opens and closes the file: what is written is there whatever happens next.
    proc csv_write {path mode lines} {
        if {[catch {
            set channel [open $path $mode]
            fconfigure $channel -encoding utf-8 -translation lf
            foreach line $lines { puts $channel $line }
            close $channel
        } message]} {
            catch { close $channel }
            fail "-csv: the file '$path' cannot be written ($message)" IO
        }
    }

    # As they stand in the file.
    proc csv_one_line_values {about} {
        set head [dict create]
        dict for {key value} $about { dict set head $key [one_line $value] }
        return $head
    }

    proc csv_head {head} {
        variable csv_columns
        set lines {}
        dict for {key value} $head { lappend lines "# $key: $value" }
        return [lappend lines [join $csv_columns ,]]
    }

    # Rows of an earlier run and what they were made with; a last line that is not complete is cut off.
    proc csv_read {path about} {
        variable csv_columns
        set channel [open $path r]
        fconfigure $channel -encoding utf-8 -translation lf
        set text [read $channel]
        close $channel
        set lines [split $text \n]
        set incomplete [lindex $lines end]
        set rows {}
        set head {}
        set n 0
        set header 0
        foreach line [lrange $lines 0 end-1] {
            incr n
            if {[regexp {^# ([^:]+): ?(.*)$} $line all key value]} {
                csv_compare $path $about $key $value
                dict set head $key $value
            } elseif {!$header} {
                if {$line ne [join $csv_columns ,]} {
                    fail "-csv: line $n of '$path' is not this version's line of columns" FORMAT
                }
                set header 1
            } else {
                set cells [csv_cells $line]
                if {[llength $cells] != [llength $csv_columns]} {
                    fail "-csv: line $n of '$path' has [llength $cells] columns instead of\
                        [llength $csv_columns]" FORMAT
                }
                set row [dict create]
                foreach column $csv_columns cell $cells { dict set row $column $cell }
                lappend rows $row
            }
        }
        if {!$header} { csv_write $path w {}; return {} }
        if {$incomplete ne ""} { csv_write $path w [lrange $lines 0 end-1] }
        return [list $rows $head]
    }

    proc csv_compare {path about key value} {
        if {![dict exists $about $key] || [one_line [dict get $about $key]] eq $value} return
        fail "-csv: '$path' was made with $key '$value', not with '[one_line [dict get $about $key]]'; -overwrite 1\
            begins anew"
    }
}
