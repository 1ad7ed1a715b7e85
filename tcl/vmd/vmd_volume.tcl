# vmd_volume.tcl: passes potential maps out of VMD and into it, through memory, or through DX files as a fallback.

namespace eval ::espdiff {
    variable n_volumes 0  ;# for names that are never reused

    # Data set K of a molecule as the core's map; files for the caller to delete are appended to `temporary`.
    proc vmd_take_map {mol k role temporary_name} {
        upvar 1 $temporary_name temporary
        set mol [vmd_molecule_id $mol "$role map"]
        vmd_require_map $mol $k "$role map"
        set label "mol $mol \"[molinfo $mol get name]\" map $k"
        set name [volume_name]
        if {[dict get [core::abi] in_vmd]} { vmd_write_volume espdiffvolume $name $mol $k }
        if {$name in [core::volumes]} {
            set map [dict create memory $name name $label]
            set volume [core::describe_volume $name]
            if {[dict get $volume unit] ne "unknown"} { return $map }
            return [dict merge $map [vmd_map_unit $mol [dict get $volume dataname]]]
        }
        set path [temporary_file .dx]
        lappend temporary $path
        if {![vmd_write_volume dx $path $mol $k] || [file size $path] == 0} {
            fail "$role map: VMD could not write data set $k of molecule $mol; see its console" IO
        }
        return [dict create file $path]
    }

    # {unit U} of a data set that VMD calls "FILE : DX map", or nothing. VMD stores no units. PMEPot's, whose files are
    # temporary, is kT/e; for other maps the unit is read from their files, if they still exist.
    proc vmd_map_unit {mol dataname} {
        if {![regexp {^(\S.*) : } $dataname all name]} { return {} }
        if {[string match pmedx_* $name]} { return {unit kT/e} }
        foreach path [lindex [molinfo $mol get filename] 0] {
            if {[file tail $path] ne $name || ![file isfile $path]} continue
            set unit [core::map_unit $path]
            if {$unit ne "unknown"} { return [list unit $unit] }
        }
        return {}
    }

    proc vmd_require_map {mol k what} {
        set n [molinfo $mol get numvolumedata]
        set name "molecule $mol ([molinfo $mol get name])"
        if {![string is integer -strict $k]} { fail "$what: '$k' is not the number of a data set of $name" }
        if {$k >= 0 && $k < $n} return
        set there [lindex {"has no data sets" "has data set 0 only"} $n]
        if {$n > 1} { set there "has data sets 0 to [expr {$n - 1}]" }
        fail "$what: there is no data set $k, $name $there; `mol addfile FILE.dx waitfor all $mol` adds one"
    }

    # VMD ignores its writers' return values, so the caller must check whether the volume arrived. At most one frame: a
    # molecule with maps only has none, and VMD would complain about frame 0.
    proc vmd_write_volume {type name mol k} {
        set range [expr {[molinfo $mol get numframes] > 0 ? "beg 0 end 0" : ""}]
        quietly { set code [catch { animate write $type $name {*}$range volsets [list $k] $mol }] }
        expr {!$code}
    }

    # Evaluates `body` in the caller without VMD's lines about files: our volumes in memory have names that mean nothing
    # to a user. Warnings and errors are printed.
    proc quietly {body} {
        if {[catch { vmdcon -loglevel } level]} { return [uplevel 1 $body] }
        vmdcon -loglevel warn
        finally { uplevel 1 $body } { vmdcon -loglevel $level }
    }

    proc volume_name {} {
        variable n_volumes
        return espdiff-[pid]-[incr n_volumes]
    }

    # The folder of temporary files.
    proc temporary_place {} {
        foreach name {TMPDIR TEMP TMP} {
            if {[info exists ::env($name)] && [file isdirectory $::env($name)]} { return $::env($name) }
        }
        return /tmp
    }

    # A new file readable only by this user.
    proc temporary_file {extension} {
        variable n_volumes
        set folder [temporary_place]
        for {set i 0} {$i < 100} {incr i} {
            set path [file join $folder espdiff-[pid]-[format %08x [expr {int(rand() * 0x7fffffff)}]]$extension]
            if {![catch { open_file $path {WRONLY CREAT EXCL} 0600 } channel]} {
                close $channel
                return $path
            }
        }
        fail "no temporary file can be made in '$folder' ($channel); TMPDIR names another folder" IO
    }

    # Loads a volume of a type into a molecule; returns whether it arrived. The molecule's id must come last: VMD
    # ignores `molid N` and loads into the top molecule.
    proc vmd_add_volume {type name mol} {
        set n [molinfo $mol get numvolumedata]
        quietly { catch { mol addfile $name type $type waitfor all $mol } }
        expr {[molinfo $mol get numvolumedata] == $n + 1}
    }

    proc map {options handle} {
        require_core_handle $handle
        set quantity [dict get $options quantity]
        set spacing [dict get $options spacing]
        set mol [dict get $options mol]
        set path [dict get $options file]
        if {($mol eq "") == ($path eq "")} { fail "espdiff map: give one of -mol ID and -file FILE.dx" }
        if {$path ne ""} { return [core::write_map $handle $quantity $spacing $path [dict get $options overwrite]] }
        set mol [vmd_molecule_id $mol "espdiff map"]
        set name [core::put_map $handle $quantity $spacing]
        finally {
            keep_view { set arrived [vmd_add_volume espdiffmap $name $mol] }
        } { core::forget_volume $name }
        if {!$arrived} { add_map_by_file $handle $quantity $spacing $mol }
        return [expr {[molinfo $mol get numvolumedata] - 1}]
    }

    proc add_map_by_file {handle quantity spacing mol} {
        set path [temporary_file .dx]
        finally {
            core::write_map $handle $quantity $spacing $path 1
            keep_view { set arrived [vmd_add_volume dx $path $mol] }
        } { file delete $path }
        if {!$arrived} { fail "espdiff map: VMD did not take the map into molecule $mol; see its console" IO }
    }
}
