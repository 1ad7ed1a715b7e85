# files.tcl: the one place where Tcl opens files, and which files a run's words name.

namespace eval ::espdiff {
    # Tcl's `open` starts a program when a name begins with `|`; a full name never does.
    proc open_file {path {access r} {permissions 0666}} { return [::open [file normalize $path] $access $permissions] }

    # The files that endpoints, maps and molecules of VMD are read from, for core::check_outputs. Each argument is a
    # list of keys and values in which `file PATH`, `map MAP` and `mol ID` count.
    proc named_files {args} {
        set paths {}
        foreach words $args {
            if {![string is list $words] || [llength $words] % 2} continue
            foreach {key value} $words {
                switch -- $key {
                    file { lappend paths $value }
                    map { lappend paths {*}[named_files $value] }
                    mol {
                        if {[in_vmd] && ![catch { molinfo $value get filename } names]} {
                            lappend paths {*}[lindex $names 0]
                        }
                    }
                }
            }
        }
        return $paths
    }
}
