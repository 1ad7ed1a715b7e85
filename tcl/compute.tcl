# compute.tcl: the commands compare and surface, and their results.

namespace eval ::espdiff {
    # The core's options besides the molecules.
    proc core_options {options} {
        variable call
        dict merge [setting_values $options] [dict create device [dict get $options device] \
            threads [dict get $options threads] command_line $call]
    }

    # The given settings. Names of files are full, because the core may read them from another working folder.
    proc setting_values {options} {
        set values [dict get $options settings]
        foreach setting [core::settings] {
            set name [dict get $setting name]
            if {$name eq "field" && [dict exists $values $name]} {
                dict set values $name [join [named_list -$name {NAME KIND} [dict get $values $name] {name kind} {
                    if {$kind eq ""} { return $name=$name }  ;# not `expr`, which makes 8 of a name 010
                    return $name=$kind
                }] |]
            } elseif {[dict get $setting kind] eq "named" && [dict exists $values $name]} {
                dict set values $name [join [named_list -$name {NAME SELECTION} [dict get $values $name] {name selection} {
                    if {[regexp {^(.+\.json)(:\d+)$} $selection -> path number]} {
                        set selection [existing_file $path "-patch $name"]$number
                    }
                    return $name=$selection
                }] |]
            }
            if {![dict get $setting file] || ![dict exists $values $name] || [dict get $values $name] eq ""} continue
            set paths {}
            set names [dict get $values $name]
            foreach path [expr {[dict get $setting list] ? [split $names ,] : [list $names]}] {
                lappend paths [existing_file $path -$name]
            }
            dict set values $name [join $paths ,]
        }
        return $values
    }

    proc prepare {options molecule} {
        variable call
        set endpoint [parse_endpoint $molecule molecule]
        foreach key {map region because} {
            if {[dict exists $endpoint $key]} { fail "molecule: `$key` is not of a preparation; leave it out" }
        }
        if {[dict exists $endpoint mol]} { dict set endpoint radii element }
        set temporary {}
        set handle [core::prepare [make_endpoint $endpoint molecule temporary] \
            [dict merge [setting_values $options] [dict create command_line $call]] \
            [file normalize [dict get $options pqr]] [dict get $options overwrite]]
        begin_job $handle $options [dict create source_mol [mol_of_endpoint $endpoint]]
    }

    # Calls the core, and removes its inputs (files, volumes in memory) if it refuses.
    proc submit {temporary_name script} {
        upvar 1 $temporary_name temporary
        if {[catch { uplevel 1 $script } result error]} {
            foreach path $temporary { file delete -force $path }
            foreach name [core::volumes] { if {[string match espdiff-[pid]-* $name]} { core::forget_volume $name } }
            return -options $error $result
        }
        return $result
    }

    proc compare {options source target} {
        set temporary {}
        lassign [with_usual_maps [list $source $target]] source target
        set handle [submit temporary {
            core::compare [make_endpoint $source source temporary] [make_endpoint $target target temporary] \
                [core_options $options]
        }]
        begin_job $handle $options [dict create temporary $temporary \
            source_mol [mol_of_endpoint $source] target_mol [mol_of_endpoint $target] \
            source_frame [frame_of_endpoint $source] target_frame [frame_of_endpoint $target]]
    }

    proc surface {options molecule} {
        set temporary {}
        set handle [submit temporary {
            core::surface [make_endpoint $molecule molecule temporary] \
                [dict merge [core_options $options] \
                    [dict create regularize [dict get $options regularize]]]
        }]
        begin_job $handle $options [dict create temporary $temporary \
            source_mol [mol_of_endpoint $molecule] target_mol [mol_of_endpoint $molecule] \
            source_frame [frame_of_endpoint $molecule] target_frame [frame_of_endpoint $molecule]]
    }

    proc mol_of_endpoint {endpoint} {
        if {![dict exists $endpoint mol]} { return "" }
        return [vmd_molecule_id [dict get $endpoint mol] molecule]
    }

    proc frame_of_endpoint {endpoint} {
        if {![dict exists $endpoint mol]} { return "" }
        return [vmd_frame [dict get $endpoint mol] [value_or $endpoint frame now] molecule]
    }

    proc result {options handle args} {
        require_handle $handle
        set source [expr {[is_trajectory $handle] ? "trajectory_result" : "core::result"}]
        set result [$source $handle]
        set path ""
        foreach key $args {
            if {![string is list $result] || [llength $result] % 2 || ![dict exists $result $key]} {
                set where [expr {$path eq "" ? "" : " under '$path'"}]
                if {[catch { dict keys $result } keys] || [llength $keys] == 0} {
                    fail "$handle: there is no '$key'$where"
                }
                fail "$handle$where: [unknown_word key $key $keys]"
            }
            set result [dict get $result $key]
            append path [expr {$path eq "" ? "" : " "}] $key
        }
        return $result
    }

    proc residues {options handle} {
        require_core_handle $handle
        return [core::residues $handle]
    }

    proc table_of {options handle} {
        require_core_handle $handle
        return [core::table $handle]
    }

    proc export {options handle prefix} {
        require_core_handle $handle
        if {$prefix eq "" || [string match */ $prefix]} {
            fail "espdiff export: '$prefix' names no file; give a prefix, such as ${prefix}wild_mutant"
        }
        return [core::export $handle $prefix [dict get $options inputs] [dict get $options overwrite]]
    }

    proc version {options} { return [core::version] }

    # The window is sourced at first use, so that the package loads without Tk.
    proc open_window {options} {
        variable directory
        if {![info exists ::tk_version]} {
            fail "espdiff gui needs Tk, which is not loaded here; start VMD with its graphics window (not\
                `-dispdev text`), or wish"
        }
        if {[info commands ::espdiff::gui::open] eq ""} {
            uplevel #0 [list source [file join $directory gui window.tcl]]
        }
        return [gui::open]
    }
}
