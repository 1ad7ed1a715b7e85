// matrix.nf: a matrix in parts, by Nextflow: on one machine, or on a cluster by one of its executors.
//
// On this machine:
//     nextflow run matrix.nf --list variants.csv --output results --parts 16
// In Slurm's queue: the same with -process.executor slurm. `-resume` keeps the parts that are complete.
// variants.csv is a list of `espdiff matrix --list`; --options '--potential pb' goes to espdiff. results/matrix.csv and
// results/matrix.json have the bytes of one process.

nextflow.enable.dsl = 2

params.list = 'variants.csv'
params.output = 'results'
params.parts = 8
params.options = ''

process part {
    cpus 2

    input:
    val number
    val list

    output:
    path 'matrix.shard-*.state'

    script:
    """
    espdiff matrix --list ${list} ${params.options} --threads ${task.cpus} --resume -q -o matrix --shard ${number}/${params.parts}
    """
}

process merge {
    publishDir params.output, mode: 'copy'

    input:
    path states

    output:
    path 'matrix.csv'
    path 'matrix.json'

    script:
    """
    espdiff merge ${states} -q -o matrix
    """
}

workflow {
    // Paths in the list are relative to it: it is named, not copied.
    list = file(params.list).toAbsolutePath().toString()
    merge(part(Channel.of(1..params.parts), list).collect())
}
