; One of each form of the language that an action may have.
(define (domain kitchen)
  (:requirements :adl :numeric-fluents :derived-predicates)
  (:types robot thing - object cup fridge - thing place - (either thing object))
  (:constants sink - thing anything)
  (:predicates (at ?r - robot ?x - (either thing place)) (open ?x) (holding ?r - robot ?x - cup) (reachable ?r ?x))
  (:functions (fuel ?r - robot) - number (total-cost) - number)
  (:derived (reachable ?r - robot ?x - thing) (or (at ?r ?x) (exists (?y - thing) (and (reachable ?r ?y) (= ?x ?y)))))
  (:action GoTo
    :parameters (?r - robot ?x - thing)
    :precondition (and (not (at ?r ?x)) (imply (open ?x) (>= (fuel ?r) (+ 1 2.5 (* 2 (fuel ?r))))))
    :effect (and (at ?r ?x)
      (forall (?y - thing) (when (and (at ?r ?y) (not (= ?x ?y))) (not (at ?r ?y))))
      (decrease (fuel ?r) 1) (increase (total-cost) (- (fuel ?r)))))
  (:durative-action Open
    :parameters (?r - robot ?x - fridge)
    :duration (= ?duration (/ 6 (fuel ?r)))
    :condition (and (at start (at ?r ?x)) (over all (forall (?y - cup) (not (holding ?r ?y)))))
    :effect (at end (open ?x))))
