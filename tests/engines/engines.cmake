# Sweeps by dask, GNU parallel and Slurm. If its engine is missing, a test is skipped and says so: scripts/setup.sh --sweep
# --slurm installs them.
if(NOT TARGET ist_cli OR NOT TARGET ist_shared OR IST_SANITIZERS)
  return()
endif()

function(ist_add_engine_test name label script)
  ist_add_command(Sweep.${name} ${label} /usr/bin/python3 -B ${CMAKE_CURRENT_SOURCE_DIR}/${script})
  set_tests_properties(Sweep.${name} PROPERTIES ENVIRONMENT
                       "IST_LIBRARY=$<TARGET_FILE:ist_shared>;IST_COMMAND=$<TARGET_FILE:ist_cli>;PYTHONPATH=${PROJECT_SOURCE_DIR}/src/python")
endfunction()

ist_add_engine_test(Dask slow dask_test.py)
ist_add_engine_test(Parallel slow parallel_test.py)
ist_add_engine_test(SlurmByHand slow slurm_by_hand_test.py)
ist_add_engine_test(Memory slow memory_test.py)
ist_add_engine_test(Slurm long slurm_test.py)
