# report.tcl: a result as one page for a browser, and the scale that results share.

namespace eval ::espdiff {
    # A comparison's handle, or the files of any result: its prefix, or one of them.
    proc report {options result} {
        set path [dict get $options output]
        set folder [temporary_folder]
        finally {
            set surfaces {}
            foreach other [list_of [dict get $options range-of] "espdiff report: -range-of"] { lappend surfaces [result_prefix $folder $other].vtp }
            set prefix [result_prefix $folder $result]
            # Not `expr`, which makes 8 of a result's name 010.
            if {$path eq ""} { if {[string match $folder* $prefix]} { set path $result.html } else { set path $prefix.html } }
            core::report $prefix $path [dict get $options title] $surfaces [dict get $options overwrite]
        } { file delete -force $folder }
        return $path
    }

    # Where the files of a result are: those of a comparison in memory are written into the folder.
    proc result_prefix {folder result} {
        if {$result ni [core::handles]} {
            foreach ending {.json .vtp .csv .html} {
                if {[string match *$ending $result]} { return [string range $result 0 end-[string length $ending]] }
            }
            return $result
        }
        set kind [dict get [core::status $result] kind]
        if {$kind eq "comparison"} {
            set prefix [file join $folder $result]
            core::export $result $prefix 0 1
            return $prefix
        }
        if {$kind in {matrix ensemble}} {
            foreach path [dict get [core::result $result] files] {
                if {[string match *.json $path]} { return [file rootname $path] }
            }
        }
        fail "espdiff report: $result is a $kind without a result's files; pages are of comparisons, matrices, ensembles\
            and trajectories (name the rows, OUT.csv)"
    }

    # What -range and -range-of of a drawing say about a quantity: {LOW HIGH}, or auto.
    proc shared_range {options handle color} {
        set range [dict get $options range]
        set others [list_of [dict get $options range-of] "espdiff draw: -range-of"]
        if {$range ne "auto" || [llength $others] == 0} { return $range }
        set unit [dict get [core::range $handle $color] unit]
        set widest [drawn_range $handle $color auto]
        foreach other $others {
            require_core_handle $other
            set range [drawn_range $other $color auto]
            if {[dict get $range unit] ne $unit} {
                fail "espdiff draw: $other has its $color in '[dict get $range unit]', and $handle in '$unit'; results\
                    that share a scale have one unit"
            }
            dict set widest low [expr {min([dict get $widest low], [dict get $range low])}]
            dict set widest high [expr {max([dict get $widest high], [dict get $range high])}]
        }
        return [list [dict get $widest low] [dict get $widest high]]
    }
}
